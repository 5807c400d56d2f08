#include "program/plot.hpp"

#include "graze/base/input_error.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/trajectory_figure.hpp"
#include "graze/study/plain_states.hpp"
#include "graze/study/point_motion.hpp"
#include "picture/gnuplot_text.hpp"
#include "program/drawing.hpp"
#include "program/output_file.hpp"
#include "program/values.hpp"

#include <algorithm>

namespace graze {

namespace {

void choose_panels(const Model& model, const SimulateArguments& arguments, MotionPanelChoice& contents) {
    std::vector<std::string> histories = arguments.quantities;
    contents.chosen = !histories.empty();
    if (histories.empty())
        histories = plain_states(model);
    for (const std::string& text : histories)
        contents.histories.push_back(contents.column(requested_quantity(model, text, "--quantity")));
    std::vector<std::string> pairs = split_list(arguments.portraits);
    if (pairs.empty())
        pairs = default_portrait(model);
    if (pairs.size() % 2 != 0)
        throw InputError({"--portrait", 0, 0}, "a phase portrait needs two quantities",
                         "write them as X,Y, for example --portrait q,v");
    for (std::size_t i = 0; i < pairs.size(); i += 2) {
        const std::size_t x = contents.column(requested_quantity(model, pairs[i], "--portrait"));
        const std::size_t y = contents.column(requested_quantity(model, pairs[i + 1], "--portrait"));
        contents.portraits.emplace_back(x, y);
    }
    if (contents.histories.empty() && contents.portraits.empty())
        throw InputError("there is nothing to draw: all states are cyclic or drifting",
                         "choose what to draw by --quantity or --portrait");
}

} // namespace

PlotRequest plot_request(const Model& model, const SimulateArguments& arguments, const std::vector<bool>& marked) {
    PlotRequest request;
    request.path = arguments.plot;
    request.data_path = arguments.plot_data;
    request.style = figure_style(arguments.style);
    require_quotable(request.style.font);
    picture_ending(request.path, "--plot", figure_endings());
    require_drawing_program("gnuplot", "install gnuplot (Debian: apt-get install gnuplot-nox)");
    require_writable(request.path);
    if (!request.data_path.empty())
        require_writable(request.data_path);
    choose_panels(model, arguments, request.contents);
    request.contents.marked = arguments.events.empty() ? usual_marks(model) : marked;
    request.contents.sections = arguments.sections.size();
    return request;
}

void draw_plot(const PlotRequest& request, const MotionRecorder& recorder) {
    Figure figure = trajectory_figure(recorder);
    figure.style = request.style;
    draw_figure(figure, request.path, request.data_path);
}

} // namespace graze
