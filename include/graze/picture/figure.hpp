#pragma once

#include "graze/study/figure_style.hpp"

#include <cstddef>
#include <optional>
#include <string>
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

/// Something drawn in a panel.
struct FigureSeries {
    enum class Style { dots, circles, line, dashed, dotted, impulses, symbols, cells };
    static constexpr std::size_t grey = 1000, black = 1001; ///< colours outside of the palette
    std::string title;                                      ///< plain text; empty: not in the legend
    Style style = Style::dots;
    std::size_t colour = 0;             ///< index in a palette
    std::vector<PlanePoint> points;     ///< a point that is not finite interrupts a line
    int symbol = 7;                     ///< of symbols: its number among gnuplot's points
    bool only_in_legend = false;        ///< says there what a style means; has no points
    std::vector<PlaneBox> cells{};      ///< of cells: what is filled
    std::vector<double> along{};        ///< of lines: how far along a smooth curve each point is; empty: straight lines
    std::vector<std::size_t> corners{}; ///< points at which a smooth curve may have one
    int hatch = 0;                      ///< of cells: which of gnuplot's patterns fills them; 0: the colour alone
};

/// A short text beside a point. Where there is no room for all, those of higher rank are listed under the panel.
struct FigureLabel {
    PlanePoint at;
    std::string text;          ///< plain
    std::size_t colour = 1001; ///< as of series; black
    int rank = 0;
    std::string owner{}; ///< what it is a point of, where labels of several curves may have the same text
};

struct FigurePanel {
    std::string title;
    std::string x_label, y_label, x_unit, y_unit; ///< names and units
    std::string x_words, y_words;                 ///< what these are in words, if anything says so
    bool logarithmic_x = false, logarithmic_y = false;
    bool roomy_y = false; ///< curves keep away from the frame above and below
    bool roomy_x = false; ///< and at the sides
    std::size_t rows = 1; ///< which it spans, where panels stand beside one another
    std::optional<std::pair<double, double>> x_range, y_range;
    std::vector<FigureSeries> series;
    std::vector<double> marks; ///< thin vertical lines
    std::string marks_title{}; ///< what they mean, for the legend
    std::vector<FigureLabel> labels;
    std::vector<std::string> notes{}; ///< what stands under the panel: what it leaves out, and why
};

/// What a picture shows, however it is drawn: panels row by row.
struct Figure {
    std::string title;
    std::size_t columns = 1;
    std::vector<FigurePanel> panels;
    FigureStyle style{};
    std::vector<std::string>
        symbols{}; ///< names that are set as such wherever they stand in titles, legends and labels
};

} // namespace graze
