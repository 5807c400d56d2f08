#pragma once

#include "graze/symbolic/expression.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace graze {

/// How long a motion takes that begins where the orbit touches, with the parameter moved beyond.
struct TripTime {
    bool ended = false; ///< the end that was asked for has come, or one of the motion's own
    std::string ending; ///< "speed", "level", or as trajectories end: "singular", "terminal", ...
    double cycles = 0;  ///< until then: passes of the touch by the map, time over that of a cycle by simulation
    double time = 0;
    std::size_t contacts = 0; ///< with the touched surface until then, that at the end included
    double speed = 0;         ///< approach speed of the last of these
    std::string detail{};     ///< of a simulation that could not go on: what happened and what to do
};

/// What ends a simulation, besides the motion's own end (a singular one, a transition to the end).
struct TripEnd {
    double speed = 0;                   ///< approach speed at the touched surface; 0: any
    std::optional<Expression> quantity; ///< its level, passed in either direction
    double level = 0;
};

} // namespace graze
