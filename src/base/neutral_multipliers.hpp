#pragma once

#include <algorithm>
#include <complex>
#include <cstddef>
#include <vector>

namespace graze {

/// Adds the multipliers of so many states that an orbit brings back to whatever they were: 1 each.
/// @param multipliers largest first, as they remain
inline void add_neutral_multipliers(std::vector<std::complex<double>>& multipliers, std::size_t count) {
    const auto smaller =
        std::find_if(multipliers.begin(), multipliers.end(), [](auto one) { return std::abs(one) < 1; });
    multipliers.insert(smaller, count, 1.0);
}

} // namespace graze
