#pragma once

#include "graze/design/trip_point.hpp"
#include "graze/trip/overshoot_trip.hpp"

#include <functional>
#include <string>
#include <vector>

namespace graze {

/// How long it takes from a trip point until the device has tripped, with the control parameter moved beyond. Of a fold
/// the normal form counts from its orbit to the gate (FoldPassage).
struct TripTimes {
    std::string reason; ///< why there are none; empty if there are
    std::vector<OvershootTrip> rows;
};

/// The overshoots of a request, or one for each second decade from 1e-2 to 1e-20 of the size of the trip value; on the
/// side on which contacts begin.
std::vector<double> overshoots_of(const TripRequest& request, double value, int side);

/// Of a touch after which the motion is lost, by the map of the cycle and by simulation; of a fold by simulation of the
/// motion that begins on the orbit that folds. Where the motion persists there are none.
/// @param orbit at the trip point, or a neighbour of it @param interrupted asked between rows and steps; may be empty
TripTimes trip_times(const TripPoint& trip, const Orbit& orbit, const TripClass& found, const TripRequest& request,
                     const std::function<bool()>& interrupted = {});

} // namespace graze
