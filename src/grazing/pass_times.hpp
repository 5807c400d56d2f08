#pragma once

#include "flow/cyclic.hpp"
#include "graze/grazing/cycle_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace graze {

/// Whether a contact with the touched surface belongs to the touch: it comes nearer to the time of one than to those at
/// which the orbit meets the surface anyway. @param time since a touch; @param period of the orbit, or of its half,
/// after which the surface may be its image
inline bool is_at_touch(const CycleMap& map, double time, double period) {
    const auto distance = [&](const std::vector<double>& times) {
        double least = std::numeric_limits<double>::infinity();
        for (const double one : times)
            least = std::min(least, std::abs(without_turns(time - one, period)));
        return least;
    };
    return map.contact_times.empty() || distance(map.touch_times) < distance(map.contact_times);
}

} // namespace graze
