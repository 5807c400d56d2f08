#pragma once

#include <limits>

namespace graze {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
/// Stands for a value that does not exist, in tables and plotted lines.
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
/// Distance of 1 from the next larger number.
inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

} // namespace graze
