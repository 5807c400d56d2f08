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
    std::string reason;                             ///< why undecided, and what to do
    TripTime trip;                                  ///< above
};

struct DeviceTrialOptions {
    double share = 1e-4;      ///< distance from the trip value, as a share of it
    std::size_t cycles = 200; ///< that are simulated below
    std::function<bool()> interrupted;
};

/// Simulates a device on both sides of its trip value, without the map of the cycle. Where the end that counts as
/// tripped does not come in time, contacts that have become harder than the map can tell of do not contradict that the
/// motion is lost: then it is undecided, and so is a simulation that could not go on.
/// @param orbit at its trip point
DeviceTrial try_device(const TripPoint& trip, const Orbit& orbit, const TripClass& found, const TripRequest& request,
                       const DeviceTrialOptions& options = {});

} // namespace graze
