#include "branch/circle_minimum.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

struct Sample {
    double turns = 0, value = 0;
};

/// Returns where the parabola through three samples is least; none if that is not between the outer ones.
std::optional<double> lowest_of_parabola(const Sample& before, const Sample& middle, const Sample& after) {
    const double left = middle.turns - before.turns, right = after.turns - middle.turns,
                 fall = (middle.value - before.value) / left, rise = (after.value - middle.value) / right,
                 rate = (fall * right + rise * left) / (left + right), curvature = (rise - fall) / (left + right),
                 turns = middle.turns - 0.5 * rate / curvature;
    const bool between = curvature > 0 && turns > before.turns && turns < after.turns && turns != middle.turns;
    return between ? std::optional(turns) : std::nullopt;
}

} // namespace

double least_around(std::span<const double> samples, const std::function<std::optional<double>(double turns)>& value) {
    constexpr int parabolas = 10;
    constexpr double enough = 1e-14; // change of the value, relative to its range
    const std::size_t count = samples.size();
    const auto least = static_cast<std::size_t>(std::ranges::min_element(samples) - samples.begin());
    const double spacing = 1 / static_cast<double>(count), here = spacing * static_cast<double>(least),
                 range = *std::ranges::max_element(samples) - samples[least];
    Sample before{here - spacing, samples[(least + count - 1) % count]}, middle{here, samples[least]},
        after{here + spacing, samples[(least + 1) % count]};
    for (int i = 0; i < parabolas; ++i) {
        const auto turns = lowest_of_parabola(before, middle, after);
        const auto found = turns ? value(*turns) : std::nullopt;
        if (!found)
            break;
        const Sample next{*turns, *found};
        const bool is_lower = next.value<middle.value, is_after = next.turns> middle.turns;
        const double change = std::abs(next.value - middle.value);
        (is_lower == is_after ? before : after) = is_lower ? middle : next;
        if (is_lower)
            middle = next;
        if (change <= enough * range)
            break;
    }
    return middle.value;
}

} // namespace graze
