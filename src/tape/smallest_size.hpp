#pragma once

namespace graze {

/// What is smaller is rounded to few digits, or to none: nothing can be asked of its relative accuracy, and in the end
/// its sign is that of round-off.
inline constexpr double smallest_size = 1e-290;

} // namespace graze
