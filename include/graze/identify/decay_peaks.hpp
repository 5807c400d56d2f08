#pragma once

#include "graze/identify/decay_wave.hpp"
#include "graze/record/samples.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// Successive peaks on one side of an oscillation that dies out, one a period.
struct DecayPeaks {
    std::vector<double> times, heights; ///< above the rest position
    double rest = 0, rest_error = 0;    ///< where the oscillation comes to rest, with its standard error
    DecayWave wave{};                   ///< through all samples of these periods
};

/// The first peaks of a channel after it has first risen through the position where it is in the end, each by a
/// polynomial that fits the samples around it by least squares. The rest position is that of a damped sine through all
/// samples of these periods, likewise. Peaks that do not stand out from the noise are left out, with all behind them.
/// @param most of them
/// @throws InputError when there are fewer than two
DecayPeaks decay_peaks(SampleSource& source, std::size_t channel, std::size_t most);

} // namespace graze
