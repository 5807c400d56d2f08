#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace graze {

/// Returns the next larger number, `steps` times; infinity stays, and minus infinity gives the least number.
inline double next_above(double x, int steps = 1) {
    for (; steps > 0 && x < std::numeric_limits<double>::infinity(); --steps) {
        const auto bits = std::bit_cast<std::int64_t>(x + 0.0); // -0 becomes +0
        x = std::bit_cast<double>(bits >= 0 ? bits + 1 : bits - 1);
    }
    return x;
}

inline double next_below(double x, int steps = 1) {
    return -next_above(-x, steps);
}

} // namespace graze
