#pragma once

#include "base/median.hpp"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace graze {

/// Two neighbouring times of a record between which rows are missing.
struct RowGap {
    double from = 0, to = 0;
};

/// Median distance of neighbouring times; 0 for fewer than two.
inline double usual_step(std::span<const double> times) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < times.size(); ++i)
        steps.push_back(times[i] - times[i - 1]);
    return steps.empty() ? 0 : median(std::move(steps));
}

constexpr double longer_than_usual = 1.5; ///< steps longer than this, in usual steps, skip a row

/// The longest gap; none if no step is longer than usual.
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
