#pragma once

#include "graze/record/samples.hpp"

#include <span>
#include <vector>

namespace graze {

/// Interpolates a channel between its samples by the parabola through the two neighbouring samples and that one of the
/// next two with the smaller curvature, so that a jump next to them does no harm (essentially non-oscillatory
/// interpolation: Harten, Engquist, Osher and Chakravarthy, J. Comput. Phys. 71 (1987) 231). The error is of third
/// order in the spacing where the channel is smooth; across a jump it is as large as the jump.
/// @param times strictly increasing, two or more
/// @throws InputError unless the time lies between the first and the last of them
double interpolate(std::span<const double> times, std::span<const double> values, double time);

/// Interpolates all channels at a time.
std::vector<double> interpolate(const Samples& samples, double time);

} // namespace graze
