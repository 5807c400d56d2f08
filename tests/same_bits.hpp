#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace graze::testing {

/// True for equal bits; all NaN are the same.
inline bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

} // namespace graze::testing
