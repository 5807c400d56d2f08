#pragma once

#include "graze/identify/decay_peaks.hpp"
#include "identify/noise.hpp"

namespace graze::testing {

/// A damped sine of amplitude 1. @param omega natural frequency, @param zeta damping ratio
inline double damped_cosine(double omega, double zeta, double t, double phase) {
    return std::exp(-zeta * omega * t) * std::cos(omega * std::sqrt(1 - zeta * zeta) * t + phase);
}

/// The peaks of a release, whose only channel is `v`.
inline DecayPeaks peaks_in(Samples samples, std::size_t most = 10) {
    StoredSamples source({{"t", "s"}, {{"v", "m/s"}}}, std::move(samples));
    return decay_peaks(source, 0, most);
}

} // namespace graze::testing
