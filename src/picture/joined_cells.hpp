#pragma once

#include "graze/picture/figure.hpp"

#include <vector>

namespace graze {

/// The cells of a series as they are drawn: of stored points those beside one another in a row are joined, and then
/// equal ones above one another, so that a map has few gaps and few shapes. Others, such as the bars of a histogram,
/// stay as they are.
std::vector<PlaneBox> joined_cells(const FigureSeries& series);

} // namespace graze
