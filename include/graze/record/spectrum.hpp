#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace graze {

/// Amplitude spectrum of samples.
struct Spectrum {
    std::vector<double> frequencies; ///< (k - 1) f/N for k = 2 ... N/2 + 1
    std::vector<double> amplitudes;  ///< 2 |I(k)|/N of the samples less their mean; half that at f/2
    double mean = 0;
};

/// Returns the amplitude spectrum of equidistant samples by discrete Fourier transform (Eq. (5.20) of B. E. Wilcox's
/// dissertation, with f_k = (k - 1) f/N instead of the printed one).
/// @param frequency sampling frequency, in samples per unit of time
/// @param interrupted called now and then; returns true to stop
/// @return empty when it was interrupted
Spectrum spectrum(std::span<const double> samples, double frequency, const std::function<bool()>& interrupted = {});

/// Returns the averaged spectrum of a record of any length: the root of the mean squared amplitudes of parts that
/// overlap by half, each less its mean and with Hann's window, whose gain is corrected (P. D. Welch, IEEE Trans. Audio
/// Electroacoust. 15 (1967) 70). The window spreads the amplitude of a wave to the neighbouring frequencies.
/// @param part samples of each part, 8 or more
/// @param interrupted called now and then; returns true to stop
/// @return empty when it was interrupted
/// @throws InputError when the record is shorter, or its samples are not equidistant in time
Spectrum averaged_spectrum(SampleSource& source, std::size_t channel, std::size_t part,
                           const std::function<bool()>& interrupted = {});

/// Returns the number of samples per unit of time. @throws InputError for fewer than two, or when a distance differs
/// from the mean one by more than a quarter
double sampling_frequency(std::span<const double> times);

} // namespace graze
