#pragma once

#include <ctime>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace peers {

/// What a run at one tolerance takes and how wrong its result is.
struct Effort {
    double tolerance = 0, seconds = 0, error = 0;
};

/// Time of the processor, which others who use the machine do not lengthen much.
inline double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The least of several times, of which there are the more the shorter they are.
template <class Run>
double least_seconds(double budget, Run&& run) {
    constexpr int most = 200;
    double least = INFINITY, spent = 0;
    for (int i = 0; i < most && (i == 0 || spent < budget); ++i) {
        const double begin = processor_seconds();
        run();
        const double time = processor_seconds() - begin;
        least = std::min(least, time);
        spent += time;
    }
    return least;
}

/// The time at which an error is reached: between the two tolerances around it, straight in logarithms; that of the
/// loosest tolerance if even that gives less. None if no tolerance gives as little.
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
