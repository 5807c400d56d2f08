#pragma once

#include <algorithm>
#include <complex>
#include <cstddef>
#include <vector>

namespace graze {

/// Inserts `count` multipliers equal to 1, one for each neutral state: a state that returns to any value it starts
/// from.
/// @param multipliers sorted by falling magnitude, and kept so
inline void add_neutral_multipliers(std::vector<std::complex<double>>& multipliers, std::size_t count) {
    const auto smaller =
        std::find_if(multipliers.begin(), multipliers.end(), [](auto one) { return std::abs(one) < 1; });
    multipliers.insert(smaller, count, 1.0);
}

} // namespace graze
