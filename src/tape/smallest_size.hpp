#pragma once

namespace graze {

/// Smaller numbers are rounded to few digits (subnormals) or to zero: their relative accuracy and sign are meaningless.
inline constexpr double smallest_size = 1e-290;

} // namespace graze
