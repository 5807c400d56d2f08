#pragma once

#include <span>

namespace graze {

/// Returns the largest deviation of times from the nearest equidistant ones with this spacing.
double deviation_from_even(std::span<const double> times, double spacing);
/// Returns the deviation that rounding can cause: the last decimal place of the times, if it is not far below their
/// spacing, plus the rounding of doubles.
double rounding_of(std::span<const double> times, double spacing);
/// Whether the times are equidistant but for their rounding; other times are used as they are.
bool is_even_clock(std::span<const double> times);

/// @throws InputError when times deviate from equidistant ones by more than `allowed`
void require_even(std::span<const double> times, double spacing, double allowed);
/// Returns the sampling frequency for methods that assume equidistant samples, such as a spectrum: other samples would
/// shift and smear its lines.
/// @throws InputError when times deviate from equidistant ones by more than rounding and a twentieth of a step, at
/// which a wave of half the sampling frequency loses 1 %
double even_sampling_frequency(std::span<const double> times);

} // namespace graze
