#pragma once

#include "graze/grazing/cycle_map.hpp"

#include <span>

namespace graze {

/// The position relative to the surface, and the contact, of a motion that starts at a touch.
struct TouchMeeting {
    double gap = 0, rate = 0; ///< value and rate of the event function at the start
    double speed = 0;         ///< approach speed of the contact; 0 without one
};
TouchMeeting meeting_of(const CycleMap& map, double overshoot, std::span<const double> disturbance);

/// Returns the derivative of the event function with respect to the parameter at the fixed state of the touch.
double explicit_rate(const CycleMap& map);

/// @throws InputError unless a trip can start at the touch with this overshoot and disturbance
void require_trip(const CycleMap& map, double overshoot, std::span<const double> disturbance);

} // namespace graze
