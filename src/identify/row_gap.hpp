#pragma once

#include "base/median.hpp"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace graze {

/// Two neighbouring times between which rows are missing.
struct RowGap {
    double from = 0, to = 0;
};

/// The median of the distances of times; 0 of fewer than two.
inline double usual_step(std::span<const double> times) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < times.size(); ++i)
        steps.push_back(times[i] - times[i - 1]);
    return steps.empty() ? 0 : median(std::move(steps));
}

constexpr double longer_than_usual = 1.5; ///< a step over which a row is missing

/// The longest one; none where all steps are about as long.
inline std::optional<RowGap> longest_gap(std::span<const double> times) {
    std::optional<RowGap> longest;
    const double usual = usual_step(times);
    for (std::size_t i = 1; i < times.size(); ++i)
        if (const double step = times[i] - times[i - 1];
            step > longer_than_usual * usual && (!longest || step > longest->to - longest->from))
            longest = {times[i - 1], times[i]};
    return longest;
}

} // namespace graze
