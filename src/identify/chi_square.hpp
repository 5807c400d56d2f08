#pragma once

#include <cstddef>

namespace graze {

/// The chance that a sum of squares of so many independent normal variables of variance one is larger (1 without any).
/// @param squares not negative
double chi_square_tail(double squares, std::size_t freedom);

} // namespace graze
