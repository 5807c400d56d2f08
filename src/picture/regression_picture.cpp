#include "picture/box.hpp"
#include "picture/picture_kinds.hpp"

#include "graze/results/regression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace graze {

namespace {

/// The points of each regression line, by the value of the grouping variable.
std::map<double, FigureSeries> groups_of(const StudyPicture& picture, const StoredRun& run, const std::string& x,
                                         const std::string& y) {
    auto rows = run.rows({.samples = true,
                          .columns = {"number", "label"},
                          .quantities = {picture.group.empty() ? "0" : picture.group, picture.successive ? "0" : x},
                          .values = {y},
                          .samplings = shown_samplings(picture, run),
                          .sorted_by = picture.group});
    std::map<double, FigureSeries> groups;
    std::int64_t last = -1;
    double before = 0;
    const bool judged = seeks_attractors(run.record);
    while (rows.next()) {
        if (judged && drawn_as(rows.text(1)) == DrawnAs::nothing)
            continue; // no regression through unbounded or failed motions
        const double value = rows.number(4);
        const auto number = static_cast<std::size_t>(rows.integer(0));
        if (!picture.successive)
            groups[rows.number(2)].add({rows.number(3), value}, number);
        else if (rows.integer(0) == last)
            groups[rows.number(2)].add({before, value}, number);
        last = rows.integer(0);
        before = value;
    }
    return groups;
}

/// The regression line, and the range of x of its points.
struct RegressionLine {
    Regression line;
    Extent range;
};

RegressionLine fit_of(const StudyPicture& picture, const std::vector<PlanePoint>& points) {
    RegressionLine fit;
    std::vector<double> xs, ys;
    for (const PlanePoint& point : points) {
        const bool in_range = !picture.fit || (point.x > picture.fit->first && point.x < picture.fit->second);
        if (!in_range || (picture.logarithmic_x && !(point.x > 0)) || (picture.logarithmic_y && !(point.y > 0)))
            continue;
        xs.push_back(picture.logarithmic_x ? std::log10(point.x) : point.x);
        ys.push_back(picture.logarithmic_y ? std::log10(point.y) : point.y);
        fit.range.add(point.x);
    }
    fit.line = regression(xs, ys);
    return fit;
}

FigureSeries fitted_line(const StudyPicture& picture, const RegressionLine& fit, const std::string& title,
                         std::size_t colour) {
    const Regression& line = fit.line;
    FigureSeries series{fmt::format("{}slope {:.4f}, intercept {:.4f}", title, line.slope, line.intercept),
                        FigureSeries::Style::line, colour};
    for (const double end : {fit.range.least, fit.range.greatest}) {
        const double at = line.intercept + line.slope * (picture.logarithmic_x ? std::log10(end) : end);
        series.points.push_back({end, picture.logarithmic_y ? std::pow(10, at) : at});
    }
    return series;
}

} // namespace

ResultPicture regression_picture(const StudyPicture& picture, const ResultFile& file) {
    ResultPicture result;
    const StoredRun run(file, picture.runs.front(), picture.place);
    const std::string y = chosen_values(picture, run).front();
    require_values(picture, run, {y});
    const std::string x = picture.successive ? y : first_coordinate(picture, run);
    FigurePanel panel = panel_of(picture, run, x, y, 0);
    if (picture.successive) {
        const std::string words = panel.y_words.empty() ? shown_name(picture, y) : panel.y_words;
        panel.x_words = panel.y_words = "";
        panel.x_label = words + " at one contact";
        panel.y_label = words + " at the next";
        apply_labels(panel, picture, 0);
    }
    result.table = Table({{picture.group.empty() ? "group" : picture.group, run.unit(picture.group)},
                          {"slope", ""},
                          {"slope_error", ""},
                          {"intercept", ""},
                          {"intercept_error", ""},
                          {"points", ""}});
    std::size_t colour = 0;
    for (auto& [value, points] : groups_of(picture, run, x, y)) {
        const RegressionLine fit = fit_of(picture, points.points);
        const Regression& line = fit.line;
        points.colour = colour;
        points.run = run.record.name;
        panel.series.push_back(std::move(points));
        if (line.points > 1)
            panel.series.push_back(fitted_line(
                picture, fit, picture.group.empty() ? "" : shown_value(picture, run, picture.group, value) + ": ",
                colour));
        for (const double number : {value, line.slope, line.slope_error, line.intercept, line.intercept_error,
                                    static_cast<double>(line.points)})
            result.table.add(number);
        ++colour;
    }
    if (const std::string note = note_of_left_out(run, {}); !note.empty())
        panel.notes.push_back(note);
    result.figure.panels.push_back(std::move(panel));
    return result;
}

ResultPicture scatter_picture(const StudyPicture& picture, const ResultFile& file) {
    Figure figure;
    for (std::size_t r = 0; r < picture.runs.size(); ++r) {
        const StoredRun run(file, picture.runs[r], picture.place);
        const std::string x = first_coordinate(picture, run);
        const std::vector<std::string> ys =
            picture.y.empty() ? std::vector<std::string>{run.record.is_branch() ? "period" : "lyapunov"} : picture.y;
        for (std::size_t v = 0; v < ys.size(); ++v) {
            if (v >= figure.panels.size())
                figure.panels.push_back(panel_of(picture, run, x, ys[v], v));
            FigureSeries series{picture.runs.size() > 1 ? shown_name(picture, picture.runs[r]) : "",
                                FigureSeries::Style::circles, r};
            series.run = picture.runs[r];
            const bool sampled = run.has_value(ys[v]) && !run.record.is_branch();
            const bool judged = seeks_attractors(run.record);
            FigureSeries uncertain = series_of_label(name_of(Label::unsettled));
            uncertain.title = name_of(Label::unsettled);
            uncertain.run = picture.runs[r];
            auto rows = run.rows({.samples = sampled, .columns = {"label", "number"}, .quantities = {x, ys[v]}});
            while (rows.next()) {
                if (rows.is_null(2) || rows.is_null(3))
                    continue;
                const DrawnAs drawn = judged ? drawn_as(rows.text(0)) : DrawnAs::attractor;
                if (sampled && drawn == DrawnAs::nothing)
                    continue;
                (drawn == DrawnAs::uncertain ? uncertain : series)
                    .add({rows.number(2), rows.number(3)}, static_cast<std::size_t>(rows.integer(1)));
            }
            figure.panels[v].series.push_back(std::move(series));
            if (!uncertain.points.empty())
                figure.panels[v].series.push_back(std::move(uncertain));
            if (const std::string note = sampled ? note_of_left_out(run, {}) : ""; !note.empty())
                figure.panels[v].notes.push_back(note);
        }
    }
    constexpr std::size_t most_circles = 300; // more circles would overlap
    for (FigurePanel& panel : figure.panels) {
        std::size_t points = 0;
        for (const FigureSeries& series : panel.series)
            points += series.points.size();
        for (FigureSeries& series : panel.series)
            if (points > most_circles && series.style == FigureSeries::Style::circles)
                series.style = FigureSeries::Style::dots;
    }
    return {std::move(figure)};
}

} // namespace graze
