#include "graze/record/interpolate.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

double interpolate(std::span<const double> times, std::span<const double> values, double time) {
    require_size(values.size(), times.size(), "values of a channel");
    if (times.size() < 2 || !(time >= times.front() && time <= times.back()))
        throw InputError(fmt::format("the time {} is not within the samples", time), "choose one that is");
    const auto above = std::upper_bound(times.begin() + 1, times.end() - 1, time);
    const auto i = static_cast<std::size_t>(above - times.begin()) - 1;
    const auto slope = [&](std::size_t a, std::size_t b) { return (values[b] - values[a]) / (times[b] - times[a]); };
    const double straight = values[i] + slope(i, i + 1) * (time - times[i]);
    /// Second difference at a sample; none at the ends.
    const auto bend_at = [&](std::size_t k) -> std::optional<double> {
        if (k == 0 || k + 1 == times.size())
            return std::nullopt;
        return (slope(k, k + 1) - slope(k - 1, k)) / (times[k + 1] - times[k - 1]);
    };
    const std::optional<double> here = bend_at(i), next = bend_at(i + 1);
    const double bend = here && !(next && std::abs(*next) < std::abs(*here)) ? *here : next.value_or(0);
    return straight + bend * (time - times[i]) * (time - times[i + 1]);
}

std::vector<double> interpolate(const Samples& samples, double time) {
    std::vector<double> result;
    for (const std::vector<double>& column : samples.values)
        result.push_back(interpolate(samples.times, column, time));
    return result;
}

} // namespace graze
