#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

struct PlanePoint {
    double x, y;
};

/// Something drawn in a panel.
struct FigureSeries {
    enum class Style { dots, circles, line, dashed, dotted, impulses, symbols };
    static constexpr std::size_t grey = 1000, black = 1001; ///< colours outside of the palette
    std::string title;                                      ///< plain text; empty: not in the legend
    Style style = Style::dots;
    std::size_t colour = 0;         ///< index in a palette
    std::vector<PlanePoint> points; ///< a point that is not finite interrupts a line
    int symbol = 7;                 ///< of symbols: its number among gnuplot's points
    bool only_in_legend = false;    ///< says there what a style means; has no points
};

/// A short text beside a point. Those that find no room are left out.
struct FigureLabel {
    PlanePoint at;
    std::string text;          ///< plain
    std::size_t colour = 1001; ///< as of series; black
};

struct FigurePanel {
    std::string title;
    std::string x_label, y_label, x_unit, y_unit; ///< names and units
    bool logarithmic_x = false, logarithmic_y = false;
    bool key_inside = false; ///< the legend has long lines
    bool roomy = false;      ///< curves keep away from the frame above and below
    bool roomy_x = false;    ///< and at the sides
    std::optional<std::pair<double, double>> x_range, y_range;
    std::vector<FigureSeries> series;
    std::vector<double> marks; ///< thin vertical lines
    std::vector<FigureLabel> labels;
};

/// What a picture shows, however it is drawn: panels row by row.
struct Figure {
    std::string title;
    std::size_t columns = 1;
    std::vector<FigurePanel> panels;
};

} // namespace graze
