#include "graze/picture/residual_figure.hpp"

#include "base/special_numbers.hpp"
#include "graze/study/point_motion.hpp"
#include "picture/picture_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace graze {

namespace {

constexpr std::size_t most_circles_of_residuals = 200; ///< more points are drawn as dots

void add_points(FigureSeries& series, const Identification::Curve& curve) {
    for (std::size_t i = 0; i < curve.x.size(); ++i)
        series.points.push_back({curve.x[i], curve.y[i]});
}

/// Adds two panels: measured and fitted values, and the residuals. @param panel an empty panel with axis labels
void add_residual_panels(Figure& figure, FigurePanel panel, const std::vector<Identification::Shown>& shown) {
    using Style = FigureSeries::Style;
    panel.roomy_x = panel.roomy_y = true;
    FigurePanel residuals = panel;
    residuals.y_label = "measured less fitted";
    residuals.y_words.clear();
    residuals.y_range.reset();
    FigureSeries measured{"measured", Style::circles, 0}, fitted{"fitted", Style::line, 1}, left{"", Style::dots, 0};
    for (const Identification::Shown& one : shown) {
        add_points(measured, one.measured);
        add_points(fitted, one.fitted);
        add_points(left, one.left);
        fitted.points.push_back({not_a_number, not_a_number}); // interrupts the line
    }
    if (measured.points.size() > most_circles_of_residuals)
        measured.style = Style::dots;
    panel.series = {std::move(measured), std::move(fitted)};
    residuals.series = {std::move(left)};
    figure.panels.push_back(std::move(panel));
    figure.panels.push_back(std::move(residuals));
}

/// The curves of one value, one for each record.
std::vector<Identification::Shown> shown_of(const StoredRun& run, const PointRecord& point, std::size_t value) {
    const SampleSet& samples = point.result.samples;
    std::map<double, Identification::Shown> records;
    for (std::size_t s = 0; s < samples.size(); ++s) {
        const double* row = samples.values.data() + s * samples.width;
        Identification::Shown& record = records[row[0]];
        const std::string& what = run.record.samplings[samples.samplings[s]];
        Identification::Curve& curve = what == "measured" ? record.measured
                                       : what == "fitted" ? record.fitted
                                                          : record.left;
        curve.x.push_back(row[1]);
        curve.y.push_back(row[value]);
    }
    std::vector<Identification::Shown> shown;
    for (auto& [number, record] : records)
        shown.push_back(std::move(record));
    return shown;
}

} // namespace

Figure residual_figure(const Identification& found) {
    Figure figure;
    add_residual_panels(
        figure, {.x_label = found.x.name, .y_label = found.y.name, .x_unit = found.x.unit, .y_unit = found.y.unit},
        found.shown);
    return figure;
}

ResultPicture residual_picture(const StudyPicture& picture, const ResultFile& file) {
    Figure figure;
    for (const std::string& name : picture.runs) {
        const StoredRun run(file, name, picture.place);
        if (run.record.kind != "identify" || run.record.values.size() < 3)
            throw InputError(picture.place, fmt::format("run '{}' fits nothing that could be left over", name),
                             "name a run of kind \"identify\"");
        const std::vector<std::string> known = run.value_names();
        std::vector<std::string> wanted = picture.y;
        if (wanted.empty())
            wanted.assign(known.begin() + 2, known.end());
        require_values(picture, run, wanted);
        const PointRecord point = chosen_point(run, {}, {}, picture.place);
        for (std::size_t v = 0; v < wanted.size(); ++v) {
            const auto at = std::find(known.begin(), known.end(), wanted[v]);
            add_residual_panels(figure, panel_of(picture, run, known[1], wanted[v], v),
                                shown_of(run, point, static_cast<std::size_t>(at - known.begin())));
        }
    }
    return {std::move(figure)};
}

} // namespace graze
