#pragma once

#include "graze/symbolic/expression.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace graze {

/// The duration of a trip: a motion that starts where the orbit touches, with the parameter moved beyond.
struct TripTime {
    bool ended = false; ///< the requested end was reached, or the motion ended itself
    /// "speed" or "level" when the motion is lost; "too-far": beyond the validity of the map; "none": not lost;
    /// otherwise as trajectories end: "singular", "terminal", ...
    std::string ending;
    /// Cycles until the end: passes of the touch for the map, time divided by that of a cycle for simulations.
    double cycles = 0;
    double time = 0;
    std::size_t contacts = 0; ///< contacts with the touched surface, including one at the end
    double speed = 0;         ///< approach speed of the last contact
    std::string detail{};     ///< for a failed simulation: what happened and what to do
};

/// The requested end of a simulation; a singular end or a terminal transition ends it too.
struct TripEnd {
    double speed = 0; ///< approach speed at the touched surface that ends the trip; 0: unused
    /// Quantity whose level, crossed in either direction, ends the trip; empty: unused.
    std::optional<Expression> quantity;
    double level = 0;
};

} // namespace graze
