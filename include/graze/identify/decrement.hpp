#pragma once

#include "graze/identify/decay_peaks.hpp"
#include "graze/identify/estimate.hpp"

#include <span>
#include <vector>

namespace graze {

/// Natural frequency and damping ratio of an oscillator x'' + 2 zeta w0 x' + w0^2 x = 0, from peaks of its displacement
/// or velocity in many releases.
struct Decrement {
    Estimate frequency; ///< w0, in radians by unit of time
    Estimate damping;   ///< zeta
    /// As in section 5.3.1 of B. E. Wilcox's dissertation: means over all pairs of neighbouring peaks. Noise of a peak
    /// that two pairs share cancels in such means but for the first and the last, so that most of what was measured is
    /// lost, and the pairs' scatter is no measure of their error.
    double pair_frequency = 0, pair_damping = 0;
    std::vector<DecayPeaks> fitted; ///< the same peaks as they should be
};

/// Logarithmic decrement by least squares: straight lines of one slope through the logarithms of the heights of all
/// releases, and through their times, over the number of the peak. Noise of the samples is taken to be the same for all
/// peaks, so that each weighs as the square of its height; the errors of rest positions are added.
/// @param releases two or more peaks in each, three or more in one of them, positive heights, rising times
/// @throws InputError for others
Decrement logarithmic_decrement(std::span<const DecayPeaks> releases);

/// Natural frequency and damping ratio from the waves of many releases.
struct DampedOscillation {
    Estimate frequency;    ///< w0, in radians by unit of time
    Estimate damping;      ///< zeta
    double covariance = 0; ///< of the two
    /// The chance that releases of one oscillator differ by as much; 1 of a single one.
    double chance = 1;
};

/// The mean of the releases' waves by their covariances, which is what a common fit of all samples gives. Unlike peaks,
/// whose heights are known by fewer samples and whose logarithms are bent by noise, waves have no bias.
/// @throws InputError where there is no wave
DampedOscillation damped_oscillation(std::span<const DecayWave> releases);

} // namespace graze
