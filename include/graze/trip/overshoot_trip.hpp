#pragma once

#include "graze/trip/loss_point.hpp"
#include "graze/trip/simulated_trip.hpp"

#include <optional>

namespace graze {

/// How long a motion lasts with the parameter moved beyond the point at which it is lost.
struct OvershootTrip {
    double overshoot = 0; ///< with its sign
    /// By the map alone, until contacts are hard; of a fold by its normal form.
    std::optional<PredictedTrip> predicted;
    std::optional<TripTime> continued; ///< by the map, then by simulation until the end that was asked for
    std::optional<TripTime> simulated; ///< by simulation alone, where numbers tell the overshoot from none

    /// The best that is known, one of those above: until the end that was asked for, if it has come. Null: none is.
    const TripTime* best() const;
};

/// Approach speed until which the map is asked of a trip: that of its end, as far as the map tells of contacts.
double level_until(const LossPoint& point, const TripEnd& end);

/// Of a touch: until the level by the map alone, until the end by the map and simulation, and by simulation alone.
/// @param map with respect to the parameter; @param level approach speed until which the map is asked
/// @throws InputError as predicted_trip and simulated_trip do
OvershootTrip trip_of_touch(const System& system, const CycleMap& map, const Verdict& verdict, ParameterId parameter,
                            double overshoot, double level, const TripEnd& end, const TripOptions& options = {});

/// Of a fold: from far on the one side of its orbit to far on the other, and from gate to gate (FoldPassage).
struct FoldTrip {
    double overshoot = 0;
    double cycles = 0, gate_cycles = 0; ///< by the normal form
    /// Where it would not take longer than the options allow, and numbers tell the overshoot from none.
    std::optional<SimulatedPassage> passage;
};
/// @throws InputError as cycles_of_passage and simulated_passage do
FoldTrip trip_of_fold(const System& system, const FoldPassage& fold, double overshoot, const TripEnd& end,
                      bool until_passed, const TripOptions& options = {});

} // namespace graze
