#pragma once

#include <cstddef>
#include <span>

namespace graze {

/// Straight line fitted to points by least squares.
struct Regression {
    double slope = 0, intercept = 0;
    double slope_error = 0, intercept_error = 0; ///< standard errors; 0 if there are only two points
    std::size_t points = 0;
};

/// Fits a line y = intercept + slope x. @return Regression::points is 0 if there are fewer than two different x
Regression regression(std::span<const double> x, std::span<const double> y);

} // namespace graze
