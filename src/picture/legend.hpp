#pragma once

#include "picture/box.hpp"
#include "picture/rich_text.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// An entry of a legend: a sample of a style, and its meaning.
struct LegendEntry {
    std::string title;
    RichText text{}; ///< the title as it is drawn, shortened if it is too long
    FigureSeries::Style style = FigureSeries::Style::line;
    std::size_t colour = 0;
    int symbol = 0;
    int hatch = 0;       ///< for cells: gnuplot's pattern
    bool sampled = true; ///< a sample of the style is drawn before the title
    Box box{};           ///< box on the page, including the sample
    double sample = 0;   ///< width of the sample
    double title_left = 0;
};

/// The legend of a panel: each title once, and the meaning of its vertical lines. Of more than 24 entries the first
/// ones, and the number of the others.
std::vector<LegendEntry> legend_entries(const FigurePanel& panel);
/// A common legend of all panels. A panel may lack some entries, as of motions that did not settle, but must share one
/// or have none. None if a title or a look would have two meanings.
std::optional<std::vector<LegendEntry>> joined_legend(const std::vector<std::vector<LegendEntry>>& legends);

/// Places entries in centred rows and columns. @return the height of the legend
/// @param left, top, width of the available area in points; @param font font size of the axes
/// @param symbols names that are written as symbols
double place_legend(std::vector<LegendEntry>& entries, double left, double top, double width, double font,
                    const std::vector<std::string>& symbols = {});
/// Font size of the legend for the font size of the axes.
double legend_font(double font);

} // namespace graze
