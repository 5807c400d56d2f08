#include "python/figures.hpp"
#include "python/attended.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "picture/curve.hpp"
#include "picture/figure_layout.hpp"
#include "picture/figure_look.hpp"
#include "picture/interleaved_points.hpp"
#include "picture/joined_cells.hpp"
#include "picture/page_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace graze::python {

namespace {

constexpr double points_per_mm = 72 / 25.4;

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

/// The colour with which a style is drawn, as "#0072b2".
std::string colour_of(FigureSeries::Style style, std::size_t colour, bool grey) {
    const std::array<char, 17> digits{"0123456789abcdef"};
    std::uint32_t number = style == FigureSeries::Style::dots    ? dot_number(colour, grey)
                           : style == FigureSeries::Style::cells ? cell_number(colour, grey)
                                                                 : colour_number(colour, grey);
    std::string text(7, '#');
    for (std::size_t place = 6; place > 0; --place, number >>= 4)
        text[place] = digits[number & 0xf];
    return text;
}

/// Number of gnuplot's pattern that fills cells.
int hatch_of(std::size_t colour, int hatch, bool grey) {
    return hatch != 0 ? hatch : grey ? cell_hatch(colour) : 0;
}

/// Runs of letters with their look: (text, "upright", "italic", "lowered" or "raised").
py::list piece_of(const RichText& text) {
    static constexpr std::array<const char*, 4> looks{"upright", "italic", "lowered", "raised"};
    py::list runs;
    for (const TextRun& run : text)
        runs.append(py::make_tuple(run.text, looks[static_cast<std::size_t>(run.look)]));
    return runs;
}

py::tuple piece_of(const Box& box) {
    return py::make_tuple(box.left, box.low, box.right, box.high);
}

py::dict piece_of(const FigureSeries& series, bool grey) {
    py::dict object;
    object["title"] = series.title;
    object["style"] = std::string(name_of(series.style));
    object["colour"] = colour_of(series.style, series.colour, grey);
    object["number_of_colour"] = series.colour;
    object["points"] = array_of_points(series.points);
    object["line"] = is_line(series.style) && !series.along.empty()
                         ? py::object(array_of_points(smoothed(series.points, series.along, series.corners)))
                         : py::object(object["points"]);
    object["symbol"] =
        grey && series.style == FigureSeries::Style::circles ? circle_mark(series.colour) : series.symbol;
    object["line_mark"] = grey && is_line(series.style) ? line_mark(series.colour) : 0;
    object["only_in_legend"] = series.only_in_legend;
    object["cells"] = array_of_boxes(joined_cells(series));
    object["hatch"] = series.style == FigureSeries::Style::cells ? hatch_of(series.colour, series.hatch, grey) : 0;
    return object;
}

py::dict piece_of(const FigureLabel& label, bool grey) {
    py::dict object;
    object["at"] = py::make_tuple(label.at.x, label.at.y);
    object["text"] = label.text;
    object["colour"] = colour_of(FigureSeries::Style::line, grey ? FigureSeries::black : label.colour, grey);
    object["rank"] = label.rank;
    object["owner"] = label.owner;
    return object;
}

py::dict piece_of(const FigurePanel& panel, bool grey) {
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
        series.append(piece_of(one, grey));
    for (const FigureLabel& one : panel.labels)
        labels.append(piece_of(one, grey));
    object["series"] = series;
    object["labels"] = labels;
    object["marks"] = array_of(panel.marks);
    object["marks_title"] = panel.marks_title;
    object["notes"] = panel.notes;
    return object;
}

py::list piece_of(const std::vector<LegendEntry>& legend, bool grey) {
    py::list entries;
    for (const LegendEntry& entry : legend) {
        py::dict object;
        object["title"] = entry.title;
        object["text"] = piece_of(entry.text.empty() ? rich(entry.title) : entry.text);
        object["style"] = std::string(name_of(entry.style));
        object["colour"] = colour_of(entry.style, entry.colour, grey);
        object["symbol"] =
            grey && entry.style == FigureSeries::Style::circles ? circle_mark(entry.colour) : entry.symbol;
        object["line_mark"] = grey && is_line(entry.style) ? line_mark(entry.colour) : 0;
        object["hatch"] = entry.style == FigureSeries::Style::cells ? hatch_of(entry.colour, entry.hatch, grey) : 0;
        object["sampled"] = entry.sampled;
        object["box"] = piece_of(entry.box);
        entries.append(object);
    }
    return entries;
}

/// Texts around a panel's frame: lines of its title and of the labels of its axes, its notes.
py::dict texts_of(const PanelLayout& panel) {
    py::list title, x_label, y_label, notes;
    PlanePoint notes_at{panel.frame.left, panel.frame.low};
    std::size_t tics = 0;
    for (const PlacedText& placed : panel.texts) {
        const py::list text = piece_of(placed.text);
        if (placed.upright) {
            y_label.append(text);
        } else if (placed.align == PlacedText::Align::left) {
            notes_at = notes.empty() ? PlanePoint{placed.at.x, placed.box.high} : notes_at;
            notes.append(text);
        } else if (placed.align == PlacedText::Align::centre) {
            if (placed.at.y > panel.frame.high)
                title.append(text);
            else if (tics++ >= panel.x.tics.size())
                x_label.append(text);
        }
    }
    py::dict object;
    object["title"] = title;
    object["x_label"] = x_label;
    object["y_label"] = y_label;
    object["notes"] = notes;
    object["notes_at"] = py::make_tuple(notes_at.x, notes_at.y);
    return object;
}

py::dict piece_of(const LabelPlaces& places, const PanelLayout& layout, bool grey) {
    py::list labels;
    for (const PlacedLabel& label : places.labels) {
        py::dict object;
        const PlanePoint at = off_page(label.point, layout), end = label.leader_end, middle = label.box.middle();
        object["text"] = label.text;
        object["colour"] = colour_of(FigureSeries::Style::line, grey ? FigureSeries::black : label.colour, grey);
        object["at"] = py::make_tuple(at.x, at.y);
        object["offset"] = py::make_tuple(middle.x - label.point.x, middle.y - label.point.y);
        object["box"] = piece_of(label.box);
        object["led"] = label.led;
        object["leader_end"] =
            py::make_tuple((end.x - label.box.left) / label.box.width(), (end.y - label.box.low) / label.box.height());
        labels.append(object);
    }
    py::dict object;
    object["labels"] = labels;
    object["notes"] = places.notes;
    object["omitted"] = places.omitted;
    return object;
}

PanelAxis axis_between(const std::tuple<double, double, bool>& limits) {
    PanelAxis axis;
    std::tie(axis.low, axis.high, axis.logarithmic) = limits;
    if (!std::isfinite(axis.low) || !std::isfinite(axis.high) || axis.low == axis.high ||
        (axis.logarithmic && !(axis.low > 0 && axis.high > 0)))
        throw InputError("the limits of an axis are not two different numbers", "");
    return axis;
}

/// What a function gives, made without the interpreter's lock.
template <class Make>
auto made_unlocked(const Make& make) {
    const Unlocked unlocked;
    return make();
}

/// A figure, and what is computed from it.
class HeldFigure {
public:
    explicit HeldFigure(Figure figure) : figure_(std::move(figure)) {}

    const Figure& figure() const { return figure_; }
    bool grey() const { return figure_.style.grey; }

    py::list panels() const {
        py::list panels;
        for (const FigurePanel& panel : figure_.panels)
            panels.append(piece_of(panel, grey()));
        return panels;
    }
    py::dict style() const {
        const FigureStyle& style = figure_.style;
        py::dict object;
        object["width"] = style.width;
        object["height"] = style.height;
        object["font_size"] = style.font_size;
        object["font"] = style.font;
        object["grey"] = style.grey;
        return object;
    }

    /// Positions on the page of the program's picture, in points from its lower left corner.
    py::dict layout() const {
        const FigureLayout page = made_unlocked([&] { return layout_of(figure_); });
        py::dict object;
        object["width"] = page.width;
        object["height"] = page.height;
        object["font"] = page.font;
        py::list title, panels;
        for (const PlacedText& line : page.title)
            title.append(piece_of(line.text));
        object["title"] = title;
        object["title_top"] = page.title.empty() ? page.height : page.title.front().box.high;
        object["title_low"] = page.title.empty() ? page.height : page.title.back().box.low;
        object["legend"] = piece_of(page.legend, grey());
        for (std::size_t p = 0; p < page.panels.size(); ++p) {
            const PanelLayout& panel = page.panels[p];
            py::dict one = texts_of(panel);
            one["frame"] = piece_of(panel.frame);
            one["x"] = py::make_tuple(panel.x.low, panel.x.high, panel.x.logarithmic);
            one["y"] = py::make_tuple(panel.y.low, panel.y.high, panel.y.logarithmic);
            one["y_power"] = panel.y.power;
            one["legend"] = piece_of(panel.legend, grey());
            one["covering"] = covering_lines(figure_.panels[p], panel);
            panels.append(one);
        }
        object["panels"] = panels;
        return object;
    }

    /// The lines of title and labels of axes for a frame of this size in points, and the legend.
    py::dict texts(std::size_t number, double width, double height, double font) const {
        FigurePanel panel = figure_.panels.at(number);
        const std::vector<LegendEntry> legend = legend_entries(panel);
        panel.series.clear();
        panel.labels.clear();
        panel.marks.clear();
        panel.notes.clear();
        panel.logarithmic_x = panel.logarithmic_y = false;
        panel.rows = 1;
        panel.x_range = panel.y_range = {0, 1}; // of no power of ten
        Figure one{.panels = {panel}, .style = figure_.style, .symbols = figure_.symbols};
        one.style.width = (width + 6 * font) / points_per_mm;
        one.style.height = (height + 6 * font) / points_per_mm;
        one.style.font_size = font;
        PanelLayout layout = layout_of(one).panels.front();
        for (int round = 0; round < 2; ++round) { // until the frame has this size
            one.style.width = std::max(one.style.width + (width - layout.frame.width()) / points_per_mm, 1.0);
            one.style.height = std::max(one.style.height + (height - layout.frame.height()) / points_per_mm, 1.0);
            layout = layout_of(one).panels.front();
        }
        py::dict object = texts_of(layout);
        std::vector<LegendEntry> entries = legend;
        for (LegendEntry& entry : entries)
            entry.text = rich_words(entry.title, figure_.symbols);
        object["legend"] = piece_of(entries, grey());
        return object;
    }

    /// Where the labels of a panel have room. @param x, y limits of the axes, and whether they are logarithmic
    /// @param width, height of the frame in points; positions count from its lower left corner
    /// @param avoided boxes (left, low, right, high) that labels keep free, as that of a legend
    py::dict places(std::size_t number, double width, double height, const std::tuple<double, double, bool>& x,
                    const std::tuple<double, double, bool>& y, double font,
                    const std::vector<std::array<double, 4>>& avoided) const {
        FigurePanel panel = figure_.panels.at(number);
        PanelLayout layout;
        layout.frame = {0, 0, width, height};
        layout.x = axis_between(x);
        layout.y = axis_between(y);
        panel.logarithmic_x = layout.x.logarithmic;
        panel.logarithmic_y = layout.y.logarithmic;
        if (!(width > 0 && height > 0 && font > 0))
            throw InputError("a panel has no size", "");
        // Symbols are never covered by labels: the boxes are filled with symbols.
        FigureSeries filled{.style = FigureSeries::Style::symbols};
        for (const auto& [left, low, right, high] : avoided)
            for (const PlanePoint& here : points_in({left, low, right, high}, mark_size(font)))
                if (layout.frame.holds(here))
                    filled.points.push_back(off_page(here, layout));
        panel.series.push_back(std::move(filled));
        const LabelPlaces found =
            made_unlocked([&] { return place_labels(panel, layout.frame, layout.x, layout.y, font); });
        return piece_of(found, layout, grey());
    }

    /// The crosses of consecutive series that begin with this one, in layers: the number of the series after the last,
    /// and for each layer the number of its series and its points.
    py::tuple crosses(std::size_t number, std::size_t first) const {
        const FigurePanel& panel = figure_.panels.at(number);
        if (first >= panel.series.size())
            throw InputError("a panel has no such series", "");
        const std::size_t last = last_of_crosses(panel, first);
        py::list layers;
        if (last > first)
            for (const CrossLayer& layer : interleaved_crosses(panel, first, last))
                layers.append(py::make_tuple(layer.series, array_of_points(layer.points)));
        return py::make_tuple(last + 1, layers);
    }

    std::vector<std::size_t> covering(std::size_t number, double width, double height,
                                      const std::tuple<double, double, bool>& x,
                                      const std::tuple<double, double, bool>& y) const {
        PanelLayout layout;
        layout.frame = {0, 0, width, height};
        layout.x = axis_between(x);
        layout.y = axis_between(y);
        return covering_lines(figure_.panels.at(number), layout);
    }

private:
    static std::vector<PlanePoint> points_in(const Box& box, double side) {
        std::vector<PlanePoint> points;
        const auto steps = [side](double length) { return static_cast<int>(std::ceil(std::max(length, 0.0) / side)); };
        const int across = steps(box.width() - side), up = steps(box.height() - side);
        for (int i = 0; i <= across; ++i)
            for (int j = 0; j <= up; ++j)
                points.push_back({std::min(box.left + side / 2 + side * i, std::max(box.right - side / 2, box.left)),
                                  std::min(box.low + side / 2 + side * j, std::max(box.high - side / 2, box.low))});
        return points;
    }

    Figure figure_;
};

/// The tics of a linear axis of this length, in points, with labels of this size.
std::vector<double> tics_of(double low, double high, bool horizontal, double length, double font) {
    FigurePanel panel;
    (horizontal ? panel.x_range : panel.y_range) = std::minmax(low, high);
    std::vector<double> tics;
    for (const PanelAxis::Tic& tic : panel_axis(panel, horizontal, length, font).tics)
        tics.push_back(tic.value);
    return tics;
}

/// The dashes of a line on the page, one after the other, and the numbers of points of each. Positions depend on the
/// page only, so that the dashes of lines that coincide do too.
/// @param line rows of x and y in points; one that is not finite interrupts it
py::tuple dashes_on_page(const py::array_t<double, py::array::c_style | py::array::forcecast>& line, double dash,
                         double gap, const std::array<double, 4>& frame) {
    if (line.ndim() != 2 || line.shape(1) != 2 || !(dash > 0 && gap > 0))
        throw InputError("a line has rows of two numbers, and dashes a length", "");
    std::vector<Polyline> pieces(1);
    for (py::ssize_t i = 0; i < line.shape(0); ++i)
        if (const PlanePoint point{line.at(i, 0), line.at(i, 1)}; std::isfinite(point.x) && std::isfinite(point.y))
            pieces.back().push_back(point);
        else
            pieces.emplace_back();
    const auto& [left, low, right, high] = frame;
    std::vector<PlanePoint> points;
    std::vector<std::int64_t> counts;
    for (const Polyline& piece : pieces)
        for (const Polyline& one : dashes_of(piece, {dash, gap}, {left, low, right, high})) {
            points.insert(points.end(), one.begin(), one.end());
            counts.push_back(static_cast<std::int64_t>(one.size()));
        }
    return py::make_tuple(array_of_points(points), array_of(std::move(counts)));
}

} // namespace

py::object object_of(Figure figure) {
    return py::cast(std::make_unique<HeldFigure>(std::move(figure)));
}

void bind_figures(py::module_& module) {
    py::class_<HeldFigure>(module, "Figure")
        .def_property_readonly("title", [](const HeldFigure& self) { return self.figure().title; })
        .def_property_readonly("columns", [](const HeldFigure& self) { return self.figure().columns; })
        .def_property_readonly("symbols", [](const HeldFigure& self) { return self.figure().symbols; })
        .def_property_readonly("style", &HeldFigure::style)
        .def("panels", &HeldFigure::panels)
        .def("layout", &HeldFigure::layout)
        .def("texts", &HeldFigure::texts, py::arg("panel"), py::arg("width"), py::arg("height"), py::arg("font"))
        .def("places", &HeldFigure::places, py::arg("panel"), py::arg("width"), py::arg("height"), py::arg("x"),
             py::arg("y"), py::arg("font"), py::arg("avoided"))
        .def(
            "resized",
            [](const HeldFigure& self, double width) {
                Figure figure = self.figure();
                figure.style.width = width;
                figure.style.height = 0;
                return std::make_unique<HeldFigure>(std::move(figure));
            },
            py::arg("width"), "The same figure on a page of this width in mm.")
        .def("crosses", &HeldFigure::crosses, py::arg("panel"), py::arg("first"))
        .def("covering", &HeldFigure::covering, py::arg("panel"), py::arg("width"), py::arg("height"), py::arg("x"),
             py::arg("y"));
    module.def("tics", &tics_of, py::arg("low"), py::arg("high"), py::arg("horizontal"), py::arg("length"),
               py::arg("font"));
    module.def("dashes", &dashes_on_page, py::arg("line"), py::arg("dash"), py::arg("gap"), py::arg("frame"));
    module.def("rich_words", [](const std::string& text, const std::vector<std::string>& symbols) {
        return piece_of(rich_words(text, symbols));
    });
    module.def("rich_name", [](const std::string& name) { return piece_of(rich_name(name)); });
    module.def("rich_unit", [](const std::string& unit) { return piece_of(rich_unit(unit)); });
    module.def("wrapped_lines", &wrapped_lines, py::arg("text"), py::arg("width"), py::arg("most"));
    module.def("colour",
               [](std::size_t number, bool grey) { return colour_of(FigureSeries::Style::line, number, grey); });
    module.attr("mark_size") = mark_size(1);
    module.attr("label_font") = label_font(1);
    module.attr("legend_font") = legend_font(1);
}

} // namespace graze::python
