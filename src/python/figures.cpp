#include "python/figures.hpp"

namespace graze::python {

namespace {

py::array_t<double> array_of_points(const std::vector<PlanePoint>& points) {
    std::vector<double> numbers;
    numbers.reserve(2 * points.size());
    for (const PlanePoint& point : points) {
        numbers.push_back(point.x);
        numbers.push_back(point.y);
    }
    return array_of(std::move(numbers), {static_cast<py::ssize_t>(points.size()), 2});
}

py::array_t<double> array_of_boxes(const std::vector<PlaneBox>& boxes) {
    std::vector<double> numbers;
    numbers.reserve(4 * boxes.size());
    for (const PlaneBox& box : boxes)
        numbers.insert(numbers.end(), {box.left, box.right, box.low, box.high});
    return array_of(std::move(numbers), {static_cast<py::ssize_t>(boxes.size()), 4});
}

const char* name_of(FigureSeries::Style style) {
    switch (style) {
    case FigureSeries::Style::dots:
        return "dots";
    case FigureSeries::Style::circles:
        return "circles";
    case FigureSeries::Style::line:
        return "line";
    case FigureSeries::Style::dashed:
        return "dashed";
    case FigureSeries::Style::dotted:
        return "dotted";
    case FigureSeries::Style::impulses:
        return "impulses";
    case FigureSeries::Style::symbols:
        return "symbols";
    case FigureSeries::Style::cells:
        break;
    }
    return "cells";
}

py::dict object_of(const FigureSeries& series) {
    py::dict object;
    object["title"] = series.title;
    object["style"] = name_of(series.style);
    object["colour"] = series.colour == FigureSeries::grey    ? py::object(py::str("grey"))
                       : series.colour == FigureSeries::black ? py::object(py::str("black"))
                                                              : py::object(py::int_(series.colour));
    object["points"] = array_of_points(series.points);
    object["symbol"] = series.symbol;
    object["only_in_legend"] = series.only_in_legend;
    object["cells"] = array_of_boxes(series.cells);
    object["hatch"] = series.hatch;
    return object;
}

py::dict object_of(const FigureLabel& label) {
    py::dict object;
    object["at"] = py::make_tuple(label.at.x, label.at.y);
    object["text"] = label.text;
    object["colour"] = label.colour == FigureSeries::grey    ? py::object(py::str("grey"))
                       : label.colour == FigureSeries::black ? py::object(py::str("black"))
                                                             : py::object(py::int_(label.colour));
    object["rank"] = label.rank;
    object["owner"] = label.owner;
    return object;
}

py::dict object_of(const FigurePanel& panel) {
    py::dict object;
    object["title"] = panel.title;
    object["x_label"] = panel.x_label;
    object["y_label"] = panel.y_label;
    object["x_unit"] = panel.x_unit;
    object["y_unit"] = panel.y_unit;
    object["x_words"] = panel.x_words;
    object["y_words"] = panel.y_words;
    object["logarithmic_x"] = panel.logarithmic_x;
    object["logarithmic_y"] = panel.logarithmic_y;
    object["rows"] = panel.rows;
    object["x_range"] = panel.x_range;
    object["y_range"] = panel.y_range;
    py::list series, labels;
    for (const FigureSeries& one : panel.series)
        series.append(object_of(one));
    for (const FigureLabel& one : panel.labels)
        labels.append(object_of(one));
    object["series"] = series;
    object["labels"] = labels;
    object["marks"] = array_of(panel.marks);
    object["marks_title"] = panel.marks_title;
    object["notes"] = panel.notes;
    return object;
}

} // namespace

py::object object_of(const Figure& figure) {
    py::dict object;
    object["title"] = figure.title;
    object["columns"] = figure.columns;
    py::list panels;
    for (const FigurePanel& panel : figure.panels)
        panels.append(object_of(panel));
    object["panels"] = panels;
    object["symbols"] = figure.symbols;
    return object;
}

} // namespace graze::python
