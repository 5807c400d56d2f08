#pragma once

#include "graze/identify/decay_peaks.hpp"
#include "graze/record/period.hpp"

#include <cmath>
#include <optional>
#include <vector>

namespace graze {

/// A fitted damped sine: its rest position, its peaks and its noise.
struct DecayFit {
    double value = 0, error = 0;
    double noise = 0;              ///< standard deviation of a sample
    double peak = 0, distance = 1; ///< time of one of the peaks, and the distance of neighbouring ones
    double height = 0, decay = 0;  ///< height of that peak above the rest position, and decay rate of the heights
    DecayWave wave{};

    /// Height of the envelope at a time.
    double height_at(double time) const { return height * std::exp(-decay * (time - peak)); }

    /// Time of the peak nearest to the middle of a period.
    double peak_in(const Period& period) const {
        const double middle = 0.5 * (period.begin + period.end);
        return peak + distance * std::round((middle - peak) / distance);
    }
};

/// Least-squares fit of c + exp(-decay s) (a cos(turn s) + b sin(turn s)) to the samples of whole periods, where s runs
/// from 0 to 1 over these periods.
/// @return nothing when there are too few samples, or the Gauss-Newton iteration does not converge
std::optional<DecayFit> fit_damped_sine(const std::vector<Period>& periods, const Samples& samples, std::size_t channel,
                                        double level);

} // namespace graze
