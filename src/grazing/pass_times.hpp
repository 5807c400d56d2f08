#pragma once

#include "flow/cyclic.hpp"
#include "graze/grazing/cycle_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace graze {

/// True when a contact with the touched surface belongs to the touch: its time is nearer to that of a touch than to
/// those of the orbit's other contacts with the surface. @param time since a touch; @param period of the orbit, or half
/// of it where the surface may be mapped to its image
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
