#include "page/figure_json.hpp"

#include "page/json_text.hpp"

#include <string>
#include <utility>

namespace graze {

namespace {

nlohmann::json colour_json(std::size_t colour) {
    return colour == FigureSeries::grey    ? nlohmann::json("grey")
           : colour == FigureSeries::black ? nlohmann::json("black")
                                           : nlohmann::json(colour);
}

/// One coordinate of all points.
nlohmann::json coordinates_json(const std::vector<PlanePoint>& points, double PlanePoint::*coordinate) {
    nlohmann::json::array_t list;
    list.reserve(points.size());
    for (const PlanePoint& point : points)
        list.push_back(number_json(point.*coordinate));
    return list;
}

nlohmann::json cells_json(const std::vector<PlaneBox>& cells) {
    nlohmann::json::array_t list;
    list.reserve(cells.size());
    for (const PlaneBox& cell : cells)
        list.push_back(
            {number_json(cell.left), number_json(cell.right), number_json(cell.low), number_json(cell.high)});
    return list;
}

nlohmann::json series_json(const FigureSeries& series) {
    nlohmann::json one{
        {"title", series.title},   {"style", name_of(series.style)},          {"colour", colour_json(series.colour)},
        {"symbol", series.symbol}, {"only_in_legend", series.only_in_legend}, {"hatch", series.hatch}};
    one["x"] = coordinates_json(series.points, &PlanePoint::x);
    one["y"] = coordinates_json(series.points, &PlanePoint::y);
    one["cells"] = cells_json(series.cells);
    if (!series.along.empty()) // the line is smoothed
        one["along"] = numbers_json(series.along);
    one["corners"] = series.corners;
    if (!series.run.empty()) {
        one["run"] = series.run;
        one["numbers"] = series.numbers;
    }
    return one;
}

nlohmann::json label_json(const FigureLabel& label) {
    nlohmann::json one{{"x", number_json(label.at.x)},        {"y", number_json(label.at.y)}, {"text", label.text},
                       {"colour", colour_json(label.colour)}, {"rank", label.rank},           {"owner", label.owner}};
    if (!label.run.empty()) {
        one["run"] = label.run;
        one["number"] = label.number;
    }
    return one;
}

nlohmann::json axis_json(const std::string& label, const std::string& unit, const std::string& words, bool logarithmic,
                         const std::optional<std::pair<double, double>>& range) {
    nlohmann::json one{{"label", label}, {"unit", unit}, {"words", words}, {"logarithmic", logarithmic}};
    one["range"] =
        range ? nlohmann::json::array({number_json(range->first), number_json(range->second)}) : nlohmann::json();
    return one;
}

nlohmann::json panel_json(const FigurePanel& panel) {
    nlohmann::json one{{"title", panel.title}, {"rows", panel.rows}, {"marks_title", panel.marks_title}};
    one["x"] = axis_json(panel.x_label, panel.x_unit, panel.x_words, panel.logarithmic_x, panel.x_range);
    one["y"] = axis_json(panel.y_label, panel.y_unit, panel.y_words, panel.logarithmic_y, panel.y_range);
    one["marks"] = numbers_json(panel.marks);
    one["notes"] = panel.notes;
    one["series"] = nlohmann::json::array();
    for (const FigureSeries& series : panel.series)
        one["series"].push_back(series_json(series));
    one["labels"] = nlohmann::json::array();
    for (const FigureLabel& label : panel.labels)
        one["labels"].push_back(label_json(label));
    return one;
}

} // namespace

nlohmann::json figure_json(const Figure& figure) {
    const FigureStyle& style = figure.style;
    nlohmann::json one{{"title", figure.title}, {"columns", figure.columns}, {"symbols", figure.symbols}};
    one["style"] = {{"width", number_json(style.width)},
                    {"height", number_json(style.height)},
                    {"font_size", number_json(style.font_size)},
                    {"font", style.font},
                    {"grey", style.grey}};
    one["panels"] = nlohmann::json::array();
    for (const FigurePanel& panel : figure.panels)
        one["panels"].push_back(panel_json(panel));
    return one;
}

} // namespace graze
