#pragma once

#include "graze/trip/loss_point.hpp"
#include "graze/trip/simulated_trip.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// The duration of a trip with the parameter moved beyond a touch, by several methods.
struct OvershootTrip {
    double overshoot = 0; ///< signed overshoot of the parameter
    /// By the map alone, until contacts reach the level.
    std::optional<PredictedTrip> predicted;
    std::optional<TripTime> continued; ///< by the map, then by simulation until the requested end
    std::optional<TripTime> simulated; ///< by simulation alone, where double precision resolves the overshoot

    /// Returns the most accurate of these trips that reached the requested end; null if none did.
    const TripTime* best() const;
};

/// What ends the trips from a point, with how people call it.
struct NamedEnd {
    TripEnd end;
    std::string words;
    bool given = false; ///< somebody has chosen it; otherwise it is the usual one of the point
};
/// The usual end: of a touch the approach speed up to which the map tells of contacts, of a fold its passage.
NamedEnd usual_end(const LossPoint& point);
/// An approach speed at the touched surface.
/// @throws InputError for a fold, which has no contact of its own
NamedEnd end_at_speed(const LossPoint& point, double speed);

/// Returns the approach speed until which the map predicts a trip: that of the requested end, bounded by the map's
/// validity.
double level_until(const LossPoint& point, const TripEnd& end);

/// Computes a trip beyond a touch: until the level by the map alone, until the end by map and simulation, and by
/// simulation alone.
/// @param map with respect to the parameter; @param level approach speed until which the map predicts
/// @throws InputError as predicted_trip and simulated_trip do
OvershootTrip trip_of_touch(const System& system, const CycleMap& map, const Verdict& verdict, ParameterId parameter,
                            double overshoot, double level, const TripEnd& end, const TripOptions& options = {});

/// The passage of a fold: over the whole line, and between the gates (FoldPassage).
struct FoldTrip {
    double overshoot = 0;
    double cycles = 0, gate_cycles = 0; ///< by the normal form, in total and between the gates
    /// By simulation, if the options allow as many cycles and double precision resolves the overshoot.
    std::optional<SimulatedPassage> passage;
};
/// Computes the passage of a fold. @throws InputError as cycles_of_passage and simulated_passage do
FoldTrip trip_of_fold(const System& system, const FoldPassage& fold, double overshoot, const TripEnd& end,
                      bool until_passed, const TripOptions& options = {});

/// What touches and folds have in common of a trip; NaN where an end has not come.
struct TripSummary {
    double overshoot;
    double cycles, time; ///< by the map or the normal form
    double end_time;     ///< until the end that was asked for, by simulation
};

/// Trips from one point at several overshoots.
struct OvershootTrips {
    LossPoint point;
    NamedEnd end;
    std::vector<OvershootTrip> of_touch{}; ///< where the point is a touch,
    std::vector<FoldTrip> of_fold{};       ///< and where it is a fold
    bool interrupted = false;              ///< further overshoots have no trips

    std::size_t size() const { return of_touch.size() + of_fold.size(); }
    std::vector<TripSummary> summaries() const;
    /// The simulation of a trip that has not come to its end; null when it has. @throws InputError for another index
    const TripTime* unfinished(std::size_t index) const;
};
/// @throws InputError as trip_of_touch and trip_of_fold do, and for a disturbance of a fold
OvershootTrips overshoot_trips(const LossPoint& point, const NamedEnd& end, const std::vector<double>& overshoots,
                               const TripOptions& options = {});

} // namespace graze
