#pragma once

#include "picture/figure_layout.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// For each series of a panel, the number of colours that are drawn later and cover most of its line; it must be drawn
/// wider to be visible. At most 2; all lines of a colour have the same number, series that are no lines have 0.
std::vector<std::size_t> covering_lines(const FigurePanel& panel, const PanelLayout& layout);

} // namespace graze
