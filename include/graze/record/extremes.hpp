#pragma once

#include "graze/record/period.hpp"

#include <cstddef>

namespace graze {

/// The least and the greatest value of a channel within a period, and when they are there.
struct Extremes {
    double least = 0, least_time = 0;
    double greatest = 0, greatest_time = 0;

    double peak_to_peak() const { return greatest - least; }
};

/// Between samples a parabola through three of them says it, unless there is a jump beside them.
/// @throws InputError when there is no such channel
Extremes extremes(const Period& period, std::size_t channel);

} // namespace graze
