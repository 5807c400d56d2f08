#pragma once

#include "graze/study/figure_style.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

struct PlanePoint {
    double x = 0, y = 0;
};

/// A rectangle in the coordinates of a panel.
struct PlaneBox {
    double left = 0, right = 0, low = 0, high = 0;
};

/// A series of points, lines, symbols or cells in a panel.
struct FigureSeries {
    enum class Style { dots, circles, line, dashed, dotted, impulses, symbols, cells };
    static constexpr std::size_t grey = 1000, black = 1001; ///< colours outside of the palette
    /// Added to a colour: a light tint of it, on which lines and letters can be read.
    static constexpr std::size_t pale = 2000;
    std::string title{}; ///< plain text; empty: no entry in the legend
    Style style = Style::dots;
    std::size_t colour = 0;             ///< index in the palette, or `grey` or `black`; or `pale` more
    std::vector<PlanePoint> points{};   ///< a point that is not finite interrupts a line
    int symbol = 7;                     ///< for symbols: number of gnuplot's point type
    bool only_in_legend = false;        ///< has no points and explains a style in the legend
    std::vector<PlaneBox> cells{};      ///< for cells: the filled rectangles
    std::vector<double> along{};        ///< for lines: arclength of each point, for smoothing; empty: straight lines
    std::vector<std::size_t> corners{}; ///< indices of points at which a smoothed line may have a corner
    int hatch = 0;                      ///< for cells: number of gnuplot's fill pattern; 0: solid
    std::string run{};                  ///< run whose stored points are drawn; empty: none
    std::vector<std::size_t> numbers{}; ///< number of the stored point for each point, or for each cell; or empty

    /// Adds a stored point of the run.
    void add(const PlanePoint& point, std::size_t number) {
        points.push_back(point);
        numbers.push_back(number);
    }
};

/// Stable name of a style, such as "dots".
inline std::string_view name_of(FigureSeries::Style style) {
    constexpr std::array<std::string_view, 8> names{"dots",   "circles",  "line",    "dashed",
                                                    "dotted", "impulses", "symbols", "cells"};
    return names.at(static_cast<std::size_t>(style));
}

/// A short text beside a point. If not all labels fit, those of higher rank are listed under the panel.
struct FigureLabel {
    PlanePoint at;
    std::string text;          ///< plain text
    std::size_t colour = 1001; ///< as for series; black by default
    int rank = 0;              ///< labels of lower rank are placed first
    std::string owner{};       ///< name of its curve, for lists in which labels of several curves have the same text
    std::string run{};         ///< run of the stored point beside which it stands; empty: there is none
    std::size_t number = 0;    ///< of that point
};

/// A panel with two axes.
struct FigurePanel {
    std::string title{};
    std::string x_label{}, y_label{}, x_unit{}, y_unit{}; ///< names and units
    std::string x_words{}, y_words{};                     ///< descriptions of the names; may be empty
    bool logarithmic_x = false, logarithmic_y = false;
    bool roomy_y = false; ///< larger margin between the data and the frame, above and below
    bool roomy_x = false; ///< the same at the sides
    std::size_t rows = 1; ///< number of rows that the panel spans if there are several columns
    std::optional<std::pair<double, double>> x_range{}, y_range{}; ///< limits of the axes; none: those of the data
    std::vector<FigureSeries> series{};
    std::vector<double> marks{}; ///< x of thin vertical lines
    std::string marks_title{};   ///< meaning of these lines, for the legend
    std::vector<FigureLabel> labels{};
    std::vector<std::string> notes{}; ///< sentences under the panel, as about points that are left out
};

/// The contents of a picture, independent of the drawing program: panels row by row.
struct Figure {
    std::string title{};
    std::size_t columns = 1;
    std::vector<FigurePanel> panels{};
    FigureStyle style{};
    std::vector<std::string> symbols{}; ///< names that are written as symbols in titles, legends and labels
};

} // namespace graze
