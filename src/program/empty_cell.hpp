#pragma once

#include <limits>

namespace graze {

inline constexpr double nothing = std::numeric_limits<double>::quiet_NaN(); ///< what tables show as an empty cell

} // namespace graze
