#pragma once

#include "graze/design/trip_point.hpp"
#include "graze/trip/overshoot_trip.hpp"

#include <functional>
#include <string>
#include <vector>

namespace graze {

/// Times from the trip point until the device has tripped, for overshoots of the control parameter. At a fold the
/// normal form counts the passage from its orbit to the gate (FoldPassage).
struct TripTimes {
    std::string reason; ///< why there are no times; empty if there are
    std::vector<OvershootTrip> rows;
};

/// Returns the overshoots of a request, or by default one for every second decade from 1e-2 to 1e-20 of the trip value,
/// signed towards the side on which contacts begin.
std::vector<double> overshoots_of(const TripRequest& request, double value, int side);

/// Computes trip times: at a touch where the motion is lost, by the map of the cycle and by simulation; at a fold, by
/// the normal form and by simulation from the folding orbit. There are none if the motion persists.
/// @param orbit orbit at the trip point, or of a neighbouring device @param interrupted called between rows and steps;
/// may be empty
TripTimes trip_times(const TripPoint& trip, const Orbit& orbit, const TripClass& found, const TripRequest& request,
                     const std::function<bool()>& interrupted = {});

} // namespace graze
