#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Amplitudes of what a series of samples is made of.
struct Spectrum {
    std::vector<double> frequencies; ///< (k - 1) f/N for k = 2 ... N/2 + 1
    std::vector<double> amplitudes;  ///< 2 |I(k)|/N of the samples less their mean; half that at f/2
    double mean = 0;
};

/// Discrete Fourier transform of samples at equal distances of time (Eq. (5.20) of B. E. Wilcox's dissertation, with
/// f_k = (k - 1) f/N instead of what is printed there).
/// @param frequency of the samples
Spectrum spectrum(std::span<const double> samples, double frequency);

/// The same of a record of any length: root of the mean of squared amplitudes over parts of it that overlap by half,
/// each less its mean and under Hann's window, which is allowed for in the amplitudes (P. D. Welch, IEEE Trans. Audio
/// Electroacoust. 15 (1967) 70). Of waves the amplitude is shared with the frequencies beside theirs.
/// @param part samples of each part, 8 or more
/// @throws InputError when the record is shorter, or its samples are not at equal distances of time
Spectrum averaged_spectrum(SampleSource& source, std::size_t channel, std::size_t part);

/// Samples by unit of time. @throws InputError unless there are two and all distances are within a quarter of the mean
/// one
double sampling_frequency(std::span<const double> times);

} // namespace graze
