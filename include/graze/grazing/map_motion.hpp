#pragma once

#include "graze/grazing/cycle_map.hpp"

#include <cstddef>

namespace graze {

struct MapMotionOptions {
    std::size_t transient = 2000; ///< cycles before anything is kept
    std::size_t cycles = 2000;    ///< that are looked at
    double recurrence = 1e-9;     ///< share of the largest state within which a motion has come back
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

/// What the map of a cycle settles on when the orbit without contact has a clearance below zero.
struct MapMotion {
    std::size_t period = 0;   ///< in cycles; 0 where it does not repeat
    std::size_t contacts = 0; ///< in one period, or of all cycles kept
    double largest = 0;       ///< approach speed of these contacts; of three_halves, their depth
    bool bounded = true;      ///< false: it grew without end
};

/// Iterates the map, from the orbit without contact. To leading order all is in proportion: of a square_root map only
/// clearance / (acceleration projection^2) matters, of a linear one nothing but the clearance's sign.
/// @throws InputError for a map that does not exist, a clearance that is not finite, and options out of range
MapMotion map_motion(const CycleMap& map, double clearance, const MapMotionOptions& options = {});

} // namespace graze
