#pragma once

#include "graze/picture/figure.hpp"
#include "graze/study/point_motion.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// Whether a cyclic value begins anew between two rows. @param period 0: it is none
bool comes_round(double from, double to, double period);

/// The curve through rows of a motion, interrupted where another arc begins and where a phase begins anew.
/// @param x, y which of its values
std::vector<PlanePoint> curve_of(const DenseMotion& motion, std::size_t x, std::size_t y);

} // namespace graze
