#pragma once

#include "graze/design/trip_point.hpp"
#include "graze/design/trip_times.hpp"
#include "graze/grazing/trial.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace graze {

/// Result of simulating a device just below and just above its trip value.
struct DeviceTrial {
    double below = 0, above = 0;        ///< values of the control parameter
    bool rests_below = false;           ///< the orbit exists and is stable, and the motion stays on it without a touch
    bool trips_above = false;           ///< the motion reached the end that counts as tripped
    std::string seen_below, seen_above; ///< observations in words
    TrialOutcome outcome = TrialOutcome::undecided; ///< whether the observations agree with the class
    std::string reason;                             ///< why it is undecided, and what to do
    TripTime trip;                                  ///< trip time above
};

/// Options of `try_device`.
struct DeviceTrialOptions {
    double share = 1e-4;      ///< distance from the trip value, relative to it
    std::size_t cycles = 200; ///< cycles simulated below the trip value
    std::function<bool()> interrupted;
};

/// Simulates a device on both sides of its trip value, without using the map of the cycle. If the end that counts as
/// tripped is not reached in time, but contacts have become harder than the map describes, this does not contradict a
/// loss of the motion: the outcome is undecided, as it is when the simulation cannot continue.
/// @param orbit orbit at the trip point
DeviceTrial try_device(const TripPoint& trip, const Orbit& orbit, const TripClass& found, const TripRequest& request,
                       const DeviceTrialOptions& options = {});

} // namespace graze
