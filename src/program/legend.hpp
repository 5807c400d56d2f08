#pragma once

#include "program/box.hpp"
#include "program/rich_text.hpp"

#include <cstddef>
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
    bool sampled = true; ///< a sample of the style stands before the title
    Box box{};           ///< on the page, with the sample
    double sample = 0;   ///< width of the sample
    double title_left = 0;
};

/// What a panel's legend says: each title once, and of very many the first few and how many more there are.
std::vector<LegendEntry> legend_entries(const FigurePanel& panel);
bool same_legend(const std::vector<LegendEntry>& one, const std::vector<LegendEntry>& other);

/// Places entries in rows and columns, in the middle. @return how high the legend is
/// @param left, top, width of the room; @param font size of the axes' font; @param symbols names that are set as such
double place_legend(std::vector<LegendEntry>& entries, double left, double top, double width, double font,
                    const std::vector<std::string>& symbols = {});
/// Size of the legend's font.
double legend_font(double font);

} // namespace graze
