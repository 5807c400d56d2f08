#pragma once

#include <cstddef>

namespace graze {

/// Returns the probability that a chi-square variable with `freedom` degrees of freedom exceeds `squares` (1 for 0
/// degrees of freedom).
/// @param squares not negative
double chi_square_tail(double squares, std::size_t freedom);

} // namespace graze
