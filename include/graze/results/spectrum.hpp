#pragma once

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
/// f_k = (k - 1) f/N instead of what is printed there). Time proportional to the square of their number.
/// @param frequency of the samples
Spectrum spectrum(std::span<const double> samples, double frequency);

} // namespace graze
