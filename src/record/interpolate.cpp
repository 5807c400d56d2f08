#include "graze/record/interpolate.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

double interpolate(std::span<const double> times, std::span<const double> values, double time) {
    require_size(values.size(), times.size(), "values of a channel");
    if (times.size() < 2 || !(time >= times.front() && time <= times.back()))
        throw InputError(fmt::format("the time {} is not within the samples", time), "choose one that is");
    const auto above = std::upper_bound(times.begin() + 1, times.end() - 1, time);
    const auto i = static_cast<std::size_t>(above - times.begin()) - 1;
    const auto slope = [&](std::size_t a, std::size_t b) { return (values[b] - values[a]) / (times[b] - times[a]); };
    const double straight = values[i] + slope(i, i + 1) * (time - times[i]);
    double bend = 0;
    bool known = false;
    if (i > 0) {
        bend = (slope(i, i + 1) - slope(i - 1, i)) / (times[i + 1] - times[i - 1]);
        known = true;
    }
    if (i + 2 < times.size()) {
        const double other = (slope(i + 1, i + 2) - slope(i, i + 1)) / (times[i + 2] - times[i]);
        if (!known || std::abs(other) < std::abs(bend))
            bend = other;
    }
    return straight + bend * (time - times[i]) * (time - times[i + 1]);
}

std::vector<double> interpolate(const Samples& samples, double time) {
    std::vector<double> result;
    for (const std::vector<double>& column : samples.values)
        result.push_back(interpolate(samples.times, column, time));
    return result;
}

} // namespace graze
