#pragma once

#include "graze/picture/figure.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// Values over a rectangular grid, row by row from the lowest; one that is not finite is missing.
struct ContourGrid {
    std::vector<double> x, y; ///< rising
    std::vector<double> values;
};

/// Levels at round numbers strictly between the least and the greatest value: some `about`, or fewer.
std::vector<double> contour_levels(const ContourGrid& grid, std::size_t about);

/// The line on which the values, bilinear between the grid's points, have this level: pieces of two points each, with a
/// point that is not finite behind each.
std::vector<PlanePoint> contour_line(const ContourGrid& grid, double level);

} // namespace graze
