#pragma once

#include <span>

namespace graze {

/// How far times are from the nearest ones that are all this far apart.
double stray_of(std::span<const double> times, double spacing);
/// What rounding makes of equal distances: the last decimal place that the times have, if it is not far below their
/// distance, and the rounding of doubles.
double rounding_of(std::span<const double> times, double spacing);
/// Whether the times are equal distances apart but for their rounding; others are taken as they are told.
bool is_even_clock(std::span<const double> times);

/// @throws InputError where times are off a line by more than is allowed
void require_even(std::span<const double> times, double spacing, double allowed);
/// As sampling_frequency, for what takes all distances as equal: a spectrum of other samples would show their waves at
/// other frequencies, and smeared.
/// @throws InputError where times are off a line by more than rounding and a twentieth of a step, by which the wave of
/// half the frequency loses 1 %
double even_sampling_frequency(std::span<const double> times);

} // namespace graze
