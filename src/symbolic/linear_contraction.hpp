#pragma once

#include "graze/symbolic/zero_search.hpp"
#include "symbolic/square_system.hpp"

#include <cstddef>
#include <span>

namespace graze {

/// Shrinks a box without losing zeros of a function f of mean-value form: f(x) is in constant + slopes (x - middle) for
/// all x in the box. Each unknown is solved for (one step of the interval Gauss-Seidel method).
/// @param middle a point of the box as it was when the slopes were formed
/// @return false if the box has no zero
bool contract(IntervalBox& box, std::span<const double> middle, std::span<const Interval> slopes,
              const Interval& constant);

} // namespace graze
