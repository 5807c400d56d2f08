#pragma once

#include "graze/identify/estimate.hpp"
#include "graze/record/samples.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Successive peaks on one side of an oscillation that dies out, one a period.
struct DecayPeaks {
    std::vector<double> times, heights;
};

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
/// peaks, so that each weighs as the square of its height.
/// @param releases two or more peaks in each, three or more in one of them, positive heights, rising times
/// @throws InputError for others
Decrement logarithmic_decrement(std::span<const DecayPeaks> releases);

/// The first peaks above nought of a channel after it has first risen through nought, each by a polynomial that fits
/// the samples around it by least squares. @param most of them
/// @throws InputError when there are fewer than two
DecayPeaks decay_peaks(SampleSource& source, std::size_t channel, std::size_t most);

} // namespace graze
