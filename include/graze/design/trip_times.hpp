#pragma once

#include "graze/design/trip_point.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// How long it takes from a trip point until the device has tripped, with the control parameter moved beyond.
struct TripTimeRow {
    double overshoot = 0; ///< with its sign
    /// By the map alone, until contacts are hard; of a fold by its normal form, from the fold's orbit to the passage's
    /// gate (FoldPassage).
    std::optional<PredictedTrip> predicted;
    std::optional<TripTime> continued; ///< by the map, then by simulation until the end that was asked for
    std::optional<TripTime> simulated; ///< by simulation alone, where numbers tell the overshoot from none

    /// The best that is known: until the end that was asked for, if it has come.
    const TripTime* best() const;
};

struct TripTimes {
    std::string reason; ///< why there are none; empty if there are
    std::vector<TripTimeRow> rows;
};

/// The overshoots of a request, or one for each second decade from 1e-2 to 1e-20 of the size of the trip value; on the
/// side on which contacts begin.
std::vector<double> overshoots_of(const TripRequest& request, double value, int side);

/// Of a touch after which the motion is lost, by the map of the cycle and by simulation; of a fold by simulation of the
/// motion that begins on the orbit that folds. Where the motion persists there are none.
/// @param orbit at the trip point, or a neighbour of it @param interrupted asked between rows and steps; may be empty
TripTimes trip_times(const TripPoint& trip, const Orbit& orbit, const TripClass& found, const TripRequest& request,
                     const std::function<bool()>& interrupted = {});

/// Simulates the model from a state until the end of a trip or so many periods of a clock.
/// @throws InputError for numbers that do not fit
TripTime simulate_until(const System& system, std::span<const double> parameters, std::span<const double> state,
                        std::size_t mode, double cycle, const TripEnd& end, const TripOptions& options);

} // namespace graze
