#pragma once

#include "graze/record/period.hpp"

#include <cstddef>
#include <span>

namespace graze {

/// Least-squares fit of offset + sine sin(w t) + cosine cos(w t).
struct Harmonic {
    double frequency = 0; ///< w, in radians per unit of time
    double offset = 0, sine = 0, cosine = 0;
    double offset_error = 0, sine_error = 0, cosine_error = 0; ///< standard errors, for white noise
    double covariance = 0;                                     ///< covariance of sine and cosine
    double noise = 0;                                          ///< standard deviation of the residuals
    std::size_t samples = 0;

    /// Value of the fitted function at a time.
    double at(double time) const;
    double amplitude() const;
    double amplitude_error() const;
    /// The phase in amplitude sin(w t + phase), in radians.
    double phase() const;
    double phase_error() const;
};

/// Fits a harmonic of known frequency.
/// @param frequency in radians per unit of time
/// @throws InputError for fewer than four samples, or samples over too short a part of a period to determine the three
/// numbers
Harmonic fit_harmonic(std::span<const double> times, std::span<const double> values, double frequency);

/// Finds the common frequency of several channels by least squares; the residuals of each channel are weighted relative
/// to its noise.
/// @param guess initial guess, whose error is a small part of 1/(length of the record), as from crossings; in radians
/// per unit of time
double fit_frequency(std::span<const double> times, std::span<const std::span<const double>> channels, double guess);

/// Returns the amplitude of a channel in a period, at the period's own frequency.
double amplitude(const Period& period, std::size_t channel);

} // namespace graze
