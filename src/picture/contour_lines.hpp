#pragma once

#include "graze/picture/figure.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// Values over a rectangular grid, row by row from the lowest y; a value that is not finite is missing.
struct ContourGrid {
    std::vector<double> x, y; ///< rising
    std::vector<double> values;
};

/// Levels at round numbers strictly between the least and the greatest value, approximately `about` of them.
std::vector<double> contour_levels(const ContourGrid& grid, std::size_t about);

/// The contour line of a level, with values interpolated along the edges of cells: pieces of two points each, with a
/// point that is not finite after each piece.
std::vector<PlanePoint> contour_line(const ContourGrid& grid, double level);

} // namespace graze
