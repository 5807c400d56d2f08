#pragma once

#include "picture/figure_layout.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// For each series of a panel, along how many colours that are drawn later much of it runs, rather than cross them: it
/// would be hidden unless it were wider. Up to 2; all lines of one colour have the same number, other series 0.
std::vector<std::size_t> covering_lines(const FigurePanel& panel, const PanelLayout& layout);

} // namespace graze
