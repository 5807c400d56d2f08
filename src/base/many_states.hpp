#pragma once

#include <Eigen/Core>

namespace graze {

/// Number of states above which work in blocks takes the place of steps of one column, and multipliers that do not
/// matter are not computed.
inline constexpr Eigen::Index many_states = 256;

} // namespace graze
