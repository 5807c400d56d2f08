#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <span>

namespace graze {

/// A channel between its samples: by the parabola through the two samples around the time and that one of the next two
/// with which it bends less, so that a jump beside them does no harm (essentially non-oscillatory interpolation:
/// Harten, Engquist, Osher and Chakravarthy, J. Comput. Phys. 71 (1987) 231). The error is of third order in the
/// spacing where the channel is smooth; within a jump it is the jump's.
/// @param times strictly rising, two or more
/// @throws InputError unless the time lies between the first and the last of them
double interpolate(std::span<const double> times, std::span<const double> values, double time);

/// All channels at a time.
std::vector<double> interpolate(const Samples& samples, double time);

} // namespace graze
