#pragma once

#include "picture/box.hpp"
#include "picture/rich_text.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A line of a legend: what is drawn like this is that.
struct LegendEntry {
    std::string title;
    RichText text{}; ///< the title as it is to be seen, as far as there is room
    FigureSeries::Style style = FigureSeries::Style::line;
    std::size_t colour = 0;
    int symbol = 0;
    int hatch = 0;       ///< of cells
    bool sampled = true; ///< a sample of the style stands before the title
    Box box{};           ///< on the page, with the sample
    double sample = 0;   ///< width of the sample
    double title_left = 0;
};

/// What a panel's legend says: each title once, what its vertical lines mean, and of very many the first and how many
/// more there are.
std::vector<LegendEntry> legend_entries(const FigurePanel& panel);
/// One legend for all panels, if each shows some of the same, or nothing that needs one: what a panel lacks, as motions
/// that did not settle, is no reason to repeat all else. None where a look or a title would have two meanings.
std::optional<std::vector<LegendEntry>> joined_legend(const std::vector<std::vector<LegendEntry>>& legends);

/// Places entries in rows and columns, in the middle. @return how high the legend is
/// @param left, top, width of the room; @param font size of the axes' font; @param symbols names that are set as such
double place_legend(std::vector<LegendEntry>& entries, double left, double top, double width, double font,
                    const std::vector<std::string>& symbols = {});
/// Size of the legend's font.
double legend_font(double font);

} // namespace graze
