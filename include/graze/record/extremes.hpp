#pragma once

#include "graze/record/period.hpp"

#include <cstddef>

namespace graze {

/// The least and the greatest value of a channel within a period, with their times.
struct Extremes {
    double least = 0, least_time = 0;
    double greatest = 0, greatest_time = 0;

    double peak_to_peak() const { return greatest - least; }
};

/// Finds the extremes of a channel. Between samples it uses a parabola through three of them, unless there is a jump
/// next to them.
/// @throws InputError when there is no such channel
Extremes extremes(const Period& period, std::size_t channel);

} // namespace graze
