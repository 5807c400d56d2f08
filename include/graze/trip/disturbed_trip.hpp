#pragma once

#include "graze/trip/simulated_trip.hpp"
#include "graze/trip/trip_origin.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Returns a parameter value at which a ramp may begin: so far before the loss point that the initial transient has
/// decayed there.
/// @param rate rate of change of the parameter
double beginning_of_ramp(const LossPoint& point, double rate);

struct RampedTrip {
    TripTime trip;    ///< cycles and time since the start of the ramp
    double value = 0; ///< value of the parameter at the end of the trip
};

/// Simulates a linear ramp of the parameter from its value at the origin until the end of a trip.
/// @param rate rate of change of the parameter; @param options `cycles` limits the cycles beyond the loss point
/// @throws InputError for a zero rate or one that leads away from the point, and as drive_parameter does
RampedTrip ramped_trip(const System& system, const TripOrigin& origin, double rate, const TripEnd& end,
                       const TripOptions& options = {});

/// Returns the overshoot of a slow ramp beyond a fold at the time of the trip, with the sign of the ramp: with the
/// change r of the parameter per cycle, 2.338 r^(2/3) (a b)^(-1/3), where -2.338 is the first zero of the Airy function
/// (R. Haberman, SIAM J. Appl. Math. 37, 1979).
double delay_of_ramp(const FoldPassage& fold, double rate);

/// Simulates a sinusoidal parameter, value at the origin + amplitude sin(2 pi t/period), until the end of a trip.
/// @throws InputError unless the period is positive, and as drive_parameter does
TripTime swung_trip(const System& system, const TripOrigin& origin, double amplitude, double period, const TripEnd& end,
                    const TripOptions& options = {});

/// A ramp of one rate, until its end.
struct RampRow {
    double rate = 0, from = 0; ///< of the parameter: by time, and where it begins
    RampedTrip ramped;
    std::optional<double> delay;           ///< of the end beyond the point, in the parameter; none: it has not ended
    std::optional<double> predicted_delay; ///< of a fold: see delay_of_ramp
};
/// @param from where all ramps begin; none: see beginning_of_ramp
/// @return a row for each rate, until options.interrupted
/// @throws InputError for a rate that leads away from the point, and as trip_origin and ramped_trip do
std::vector<RampRow> ramped_trips(const LossPoint& point, const std::vector<double>& rates, std::optional<double> from,
                                  const TripEnd& end, const TripOptions& options = {});

/// Trips about one value of the parameter, at which the motion rests. @return for each amplitude, until
/// options.interrupted
std::vector<TripTime> swung_trips(const LossPoint& point, const TripOrigin& origin,
                                  const std::vector<double>& amplitudes, double period, const TripEnd& end,
                                  const TripOptions& options = {});

} // namespace graze
