#pragma once

#include "graze/grazing/cycle_map.hpp"

#include <span>

namespace graze {

/// How a motion that begins at a touch meets the surface there.
struct TouchMeeting {
    double gap = 0, rate = 0; ///< of the event's function where it begins
    double speed = 0;         ///< of the contact; 0 without one
};
TouchMeeting meeting_of(const CycleMap& map, double overshoot, std::span<const double> disturbance);

/// The rate by which the parameter moves the surface itself: what the clearance is at the touch's own state.
double explicit_rate(const CycleMap& map);

/// @throws InputError unless a motion that begins at the touch can be lost by these
void require_trip(const CycleMap& map, double overshoot, std::span<const double> disturbance);

} // namespace graze
