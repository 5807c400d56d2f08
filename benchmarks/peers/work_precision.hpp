#pragma once

#include "../paired_timing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace peers {

/// Time and error of a run at one tolerance.
struct Effort {
    double tolerance = 0, seconds = 0, error = 0;
};

/// Returns the smallest of several CPU times; short runs are repeated more often. Runs that the clock cannot resolve
/// are timed together.
template <class Run>
double least_seconds(double budget, Run&& run) {
    constexpr int most = 100;
    constexpr double resolved = 1e-3;
    const double first = seconds(run, Clock::processor);
    const int together = 1 + static_cast<int>(resolved / std::max(first, 1e-3 * resolved));
    double least = together > 1 ? INFINITY : first, spent = first;
    for (int i = 0; i < most && (std::isinf(least) || spent < budget); ++i) {
        const double time = seconds(
            [&] {
                for (int j = 0; j < together; ++j)
                    run();
            },
            Clock::processor);
        least = std::min(least, time / together);
        spent += time;
    }
    return least;
}

/// Returns the time at which an error is reached, by logarithmic interpolation between two tolerances; the time of the
/// loosest tolerance if its error is smaller already; empty if no tolerance reaches the error.
inline std::optional<double> seconds_at(const std::vector<Effort>& efforts, double error) {
    std::optional<double> best;
    for (std::size_t i = 0; i < efforts.size(); ++i) {
        const Effort& here = efforts[i];
        if (!(here.error <= error))
            continue;
        double seconds = here.seconds;
        if (i > 0 && efforts[i - 1].error > error) {
            const Effort& before = efforts[i - 1];
            const double share = std::log(error / before.error) / std::log(here.error / before.error);
            seconds = before.seconds * std::pow(here.seconds / before.seconds, share);
        }
        best = best ? std::min(*best, seconds) : seconds;
    }
    return best;
}

} // namespace peers
