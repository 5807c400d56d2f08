#include "graze/record/extremes.hpp"

#include "graze/base/require.hpp"
#include "graze/record/interpolate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace graze {

namespace {

struct Peak {
    double value = 0, time = 0;
};

/// Maximum of the parabola through a sample and its neighbours. Next to a jump the second difference is much larger
/// than the neighbouring ones: then the sample itself is returned.
Peak peak_at(const std::vector<double>& times, const std::vector<double>& values, std::size_t i) {
    const Peak sample{values[i], times[i]};
    if (i < 2 || i + 2 >= values.size())
        return sample;
    const auto bend = [&](std::size_t k) {
        const double left = (values[k] - values[k - 1]) / (times[k] - times[k - 1]);
        const double right = (values[k + 1] - values[k]) / (times[k + 1] - times[k]);
        return (right - left) / (times[k + 1] - times[k - 1]);
    };
    constexpr double much = 4;
    const double here = bend(i);
    if (here == 0 || std::abs(here) > much * std::min(std::abs(bend(i - 1)), std::abs(bend(i + 1))))
        return sample;
    const double left = (values[i] - values[i - 1]) / (times[i] - times[i - 1]);
    // The slope of Newton's form of the parabola vanishes there.
    const double time = 0.5 * (times[i - 1] + times[i]) - 0.5 * left / here;
    if (!(time > times[i - 1] && time < times[i + 1]))
        return sample;
    return {values[i] + left * (time - times[i]) + here * (time - times[i]) * (time - times[i - 1]), time};
}

} // namespace

Extremes extremes(const Period& period, std::size_t channel) {
    const Samples& samples = period.samples;
    require_index(channel, samples.values.size(), "channel");
    const std::vector<double>&times = samples.times, &values = samples.values[channel];
    // Start with the ends of the period, which lie between samples.
    const double first = interpolate(times, values, period.begin), last = interpolate(times, values, period.end);
    Extremes found{first, period.begin, first, period.begin};
    const auto take = [&](const Peak& peak) {
        if (peak.value < found.least)
            found = {peak.value, peak.time, found.greatest, found.greatest_time};
        if (peak.value > found.greatest)
            found = {found.least, found.least_time, peak.value, peak.time};
    };
    take({last, period.end});
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (times[i] < period.begin || times[i] > period.end)
            continue;
        take({values[i], times[i]});
        if (i == 0 || i + 1 == times.size() ||
            (values[i] - values[i - 1]) * (values[i + 1] - values[i]) > 0) // not a local extremum
            continue;
        const Peak peak = peak_at(times, values, i);
        if (peak.time >= period.begin && peak.time <= period.end)
            take(peak);
    }
    return found;
}

} // namespace graze
