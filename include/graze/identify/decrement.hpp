#pragma once

#include "graze/identify/decay_peaks.hpp"
#include "graze/identify/estimate.hpp"

#include <span>
#include <vector>

namespace graze {

/// Natural frequency and damping ratio of an oscillator x'' + 2 zeta w0 x' + w0^2 x = 0, estimated from peaks of its
/// displacement or velocity in several releases.
struct Decrement {
    Estimate frequency; ///< w0, in radians per unit of time
    Estimate damping;   ///< zeta
    /// Means over all pairs of neighbouring peaks, as in section 5.3.1 of B. E. Wilcox's dissertation. In such means
    /// all peaks but the first and the last cancel, so most of the measured information is lost, and the scatter of the
    /// pairs does not measure their error.
    double pair_frequency = 0, pair_damping = 0;
    std::vector<DecayPeaks> fitted; ///< the peaks of each release on the fitted lines
};

/// Estimates the logarithmic decrement by weighted least squares: straight lines with a common slope through the
/// logarithms of the peak heights of all releases, and through the peak times, over the peak number. Samples of all
/// peaks are assumed to have equal noise, so a peak weighs as the square of its height. The errors of the rest
/// positions are added.
/// @param releases two or more peaks in each, three or more in at least one, positive heights, increasing times
/// @throws InputError when the releases do not satisfy this
Decrement logarithmic_decrement(std::span<const DecayPeaks> releases);

/// Natural frequency and damping ratio from the damped sines of several releases.
struct DampedOscillation {
    Estimate frequency;    ///< w0, in radians per unit of time
    Estimate damping;      ///< zeta
    double covariance = 0; ///< of the two
    /// The p value of the hypothesis that all releases are of one oscillator (F test); 1 for a single release.
    double chance = 1;
};

/// Returns the mean of the releases' damped sines, weighted by their covariances, which equals a common fit of all
/// samples. It has no bias, unlike peaks: these use fewer samples, and the logarithm of a noisy height is biased.
/// @throws InputError when there are no releases, or a wave has no frequency or no degrees of freedom
DampedOscillation damped_oscillation(std::span<const DecayWave> releases);

} // namespace graze
