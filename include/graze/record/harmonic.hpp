#pragma once

#include "graze/record/period.hpp"

#include <cstddef>
#include <span>

namespace graze {

/// offset + sine sin(w t) + cosine cos(w t), by least squares.
struct Harmonic {
    double frequency = 0; ///< w, in radians by unit of time
    double offset = 0, sine = 0, cosine = 0;
    double offset_error = 0, sine_error = 0, cosine_error = 0; ///< standard errors of white noise
    double covariance = 0;                                     ///< of sine and cosine
    double noise = 0;                                          ///< standard deviation of the samples about it
    std::size_t samples = 0;

    double amplitude() const;
    double amplitude_error() const;
    /// Of amplitude sin(w t + phase), in radians.
    double phase() const;
    double phase_error() const;
};

/// @param frequency in radians by unit of time
/// @throws InputError when there are fewer than four samples, or they are too short a part of a period to tell the
/// three
///         numbers apart
Harmonic fit_harmonic(std::span<const double> times, std::span<const double> values, double frequency);

/// The same where the frequency is known only about: all of the channels have the one for which the squares of what is
/// left are least, relative to those of each channel.
/// @param guess within a small part of 1/(length of the record) of it, as crossings tell
double fit_frequency(std::span<const double> times, std::span<const std::span<const double>> channels, double guess);

/// The amplitude of a channel in a period, at the period's own frequency.
double amplitude(const Period& period, std::size_t channel);

} // namespace graze
