#pragma once

#include <cstddef>
#include <span>

namespace graze {

/// Straight line through points by least squares.
struct Regression {
    double slope = 0, intercept = 0;
    double slope_error = 0, intercept_error = 0; ///< standard errors; 0 for two points
    std::size_t points = 0;
};

/// @return zero points when there are fewer than two different x
Regression regression(std::span<const double> x, std::span<const double> y);

} // namespace graze
