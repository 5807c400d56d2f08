#pragma once

#include "graze/picture/figure.hpp"
#include "graze/study/point_motion.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// True when a cyclic value wraps around between two rows. @param period 0: the value is not cyclic
bool wraps_around(double from, double to, double period);

/// The curve through the rows of a motion, interrupted at the beginning of arcs and where a phase wraps around.
/// @param x, y indices of its values
std::vector<PlanePoint> curve_of(const DenseMotion& motion, std::size_t x, std::size_t y);

} // namespace graze
