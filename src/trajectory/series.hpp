#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace graze {

/// Returns sum of |c_k| h^k: the size of a polynomial over a step, relative to which round-off is measured.
inline double series_size(std::span<const double> c, double h) {
    double size = 0;
    for (std::size_t k = c.size(); k-- > 0;)
        size = size * h + std::abs(c[k]);
    return size;
}

/// Relative round-off of a series: a value below this share of its size is indistinguishable from zero. An event
/// function is a sum of a few dozen rounded terms that may be larger than itself, hence more than one epsilon.
inline constexpr double roundoff = 64 * std::numeric_limits<double>::epsilon();

/// Returns the index, at least 1, of the first coefficient that decides the sign just after 0; 0 if none does.
inline std::size_t leading_index(std::span<const double> c, double h, double noise) {
    double power = 1;
    for (std::size_t k = 1; k < c.size(); ++k) {
        power *= h;
        if (std::abs(c[k]) * power > noise)
            return k;
    }
    return 0;
}

/// Returns sum of |c_k| h^k, k > 0: a bound on the distance of the polynomial from its value at 0.
inline double size_beyond_start(std::span<const double> c, double h) {
    double rest = 0;
    for (std::size_t k = c.size(); k-- > 1;)
        rest = (rest + std::abs(c[k])) * h;
    return rest;
}

/// Returns whether a function that is positive now is negative after a time, to first order.
inline bool falls_within(std::span<const double> c, double time) {
    return c[0] > 0 && c[0] + time * c[1] < 0;
}

/// Returns the share of a function's size below which flights between contacts that accumulate are not followed: what
/// they would change lies far below the tolerance.
inline double share_of_last_flights(double tolerance) {
    return std::max(4 * std::numeric_limits<double>::epsilon(), 0.01 * tolerance);
}

} // namespace graze
