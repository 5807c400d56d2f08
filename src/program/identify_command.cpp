#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/residual_figure.hpp"
#include "graze/study/identify_records.hpp"
#include "program/command_line.hpp"
#include "program/commands.hpp"
#include "program/drawing.hpp"
#include "program/identify_request.hpp"
#include "program/option_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

int identify_command(const IdentifyArguments& arguments, const Console& console) {
    const std::vector<std::string>& kinds = kinds_of_estimates();
    if (std::find(kinds.begin(), kinds.end(), arguments.what) == kinds.end())
        return identify_study(arguments, console);
    if (arguments.reading.files.empty())
        throw InputError({"FILE", 0, 0}, "no records are named", "write graze identify WHAT FILE ...");
    const std::string& plot = arguments.reading.plot;
    if (!plot.empty())
        picture_ending(plot, "--plot", {"svg", "png", "pdf", "eps"});
    if (arguments.what == "fit")
        return identify_fit(arguments, console);
    const Identification found = identify_records(identify_request(arguments), identify_files(arguments, console),
                                                  arguments.reading.files.size());
    Table table({{"name", ""}, {"unit", ""}, {"value", ""}, {"error", ""}, {"low", ""}, {"high", ""}, {"freedom", ""}});
    for (const Identification::Value& value : found.values) {
        const Estimate& estimate = value.estimate;
        const bool known = estimate.freedom > 0;
        table.add(value.name, value.unit, estimate.value, known ? estimate.error : not_a_number,
                  known ? estimate.value - estimate.half_width() : not_a_number,
                  known ? estimate.value + estimate.half_width() : not_a_number,
                  known ? estimate.freedom : not_a_number);
    }
    JsonObject heading;
    heading.add("graze", GRAZE_VERSION);
    heading.add("what", arguments.what);
    heading.add("probability", 0.95);
    if (!plot.empty())
        draw_figure(residual_figure(found), plot, arguments.reading.data);
    deliver(table, arguments.reading.output, heading, console);
    for (const std::string& warning : found.warnings)
        console.err << fmt::format("graze: warning: {}\n", in_options(warning));
    return found.warnings.empty() ? exit_success : exit_irregular;
}

} // namespace graze
