#pragma once

#include "graze/design/trip_point.hpp"
#include "graze/design/trip_times.hpp"
#include "graze/grazing/trial.hpp"

#include <functional>
#include <string>

namespace graze {

/// What simulation says of a device just below and just above its trip value.
struct DeviceTrial {
    double below = 0, above = 0;        ///< values of the control parameter
    bool rests_below = false;           ///< the orbit is there and stable, and the motion stays on it without a touch
    bool trips_above = false;           ///< the motion came to the end that counts as tripped
    std::string seen_below, seen_above; ///< in words
    TrialOutcome outcome = TrialOutcome::undecided; ///< whether that is what the class says
    TripTime trip;                                  ///< above
};

struct DeviceTrialOptions {
    double share = 1e-4;      ///< distance from the trip value, as a share of it
    std::size_t cycles = 200; ///< that are simulated below
    std::function<bool()> interrupted;
};

/// Simulates a device on both sides of its trip value, without the map of the cycle.
/// @param orbit at its trip point
DeviceTrial try_device(const TripPoint& trip, const Orbit& orbit, const TripClass& found, const TripRequest& request,
                       const DeviceTrialOptions& options = {});

} // namespace graze
