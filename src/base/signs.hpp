#pragma once

namespace graze {

/// True when one number is positive and the other negative. Their product tells this only where it is no smaller than
/// the least double, which determinants of many states are.
inline bool have_opposite_signs(double one, double other) {
    return (one < 0 && other > 0) || (one > 0 && other < 0);
}

/// True when both numbers are positive or both negative.
inline bool have_same_sign(double one, double other) {
    return (one < 0 && other < 0) || (one > 0 && other > 0);
}

} // namespace graze
