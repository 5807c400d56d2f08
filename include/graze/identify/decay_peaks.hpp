#pragma once

#include "graze/identify/residual_test.hpp"
#include "graze/record/samples.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// A damped sine c + exp(-decay t) (a cos(turn t) + b sin(turn t)), fitted by least squares to the samples of a
/// release.
struct DecayWave {
    double turn = 0, decay = 0; ///< angular frequency of the damped oscillation, and decay rate, per unit of time
    double turn_variance = 0, decay_variance = 0; ///< squared standard errors of `turn` and `decay`
    double covariance = 0;                        ///< covariance of `turn` and `decay`
    double freedom = 0;                           ///< degrees of freedom: samples less unknowns
    ResidualTest residual_test{};                 ///< test of whether the samples are a damped sine with random noise
};

/// Successive maxima of a decaying oscillation, one a period, and the damped sine through its samples.
struct DecayPeaks {
    std::vector<double> times, heights; ///< times of the maxima, and their heights above the rest position
    double rest = 0, rest_error = 0;    ///< position at which the oscillation comes to rest, with its standard error
    DecayWave wave{};                   ///< least-squares fit to all samples of these periods
};

/// Finds the first peaks of a channel, from its first rise through the final position on. Each peak is the maximum of a
/// polynomial fitted to the samples around it by least squares. The rest position is that of a damped sine fitted to
/// all samples of these periods. The list ends before the first peak that does not stand out from the noise.
/// @param most largest number of peaks
/// @throws InputError when fewer than two peaks are found
DecayPeaks decay_peaks(SampleSource& source, std::size_t channel, std::size_t most);

} // namespace graze
