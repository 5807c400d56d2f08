#pragma once

#include "graze/grazing/cycle_map.hpp"

#include <cstddef>
#include <functional>

namespace graze {

struct MapMotionOptions {
    std::size_t transient = 2000; ///< cycles discarded before the motion is examined
    std::size_t cycles = 2000;    ///< cycles examined after the transient
    double recurrence = 1e-9;     ///< a motion repeats if all states return to within this share of the largest state
    std::function<bool()> interrupted{}; ///< called now and then; returns true to stop
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

/// The long-term motion of the map of a cycle when the orbit without contact has a negative clearance.
struct MapMotion {
    std::size_t period = 0; ///< period in cycles; 0 where the motion does not repeat
    /// Number of contacts in one period, or in all examined cycles if the motion does not repeat.
    std::size_t contacts = 0;
    double largest = 0;       ///< largest approach speed of these contacts; for three_halves, largest depth
    bool bounded = true;      ///< false: the motion diverged
    bool interrupted = false; ///< it was stopped; nothing else is known then
};

/// Iterates the map from the orbit without contact. To leading order the map scales: a square_root map depends only on
/// clearance / (acceleration projection^2), a linear map only on the sign of the clearance.
/// @throws InputError if the map does not exist, the clearance is not finite or an option is out of range
MapMotion map_motion(const CycleMap& map, double clearance, const MapMotionOptions& options = {});

} // namespace graze
