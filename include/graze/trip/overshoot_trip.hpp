#pragma once

#include "graze/trip/loss_point.hpp"
#include "graze/trip/simulated_trip.hpp"

#include <optional>

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

} // namespace graze
