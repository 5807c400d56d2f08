#pragma once

#include "graze/trip/simulated_trip.hpp"
#include "graze/trip/trip_origin.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Where a ramp begins so far before the point at which the motion is lost that its beginning is forgotten there.
/// @param rate of the parameter by time
double beginning_of_ramp(const LossPoint& point, double rate);

struct RampedTrip {
    TripTime trip;    ///< cycles and time since the ramp began
    double value = 0; ///< of the parameter at its end
};

/// The parameter rises (or falls) steadily from that of the origin, as a state of constant rate, by simulation.
/// @param rate of the parameter by time; @param options cycles are those beyond the point at most
/// @throws InputError for a rate of zero or that leads away from the point, and as drive_parameter does
RampedTrip ramped_trip(const System& system, const TripOrigin& origin, double rate, const TripEnd& end,
                       const TripOptions& options = {});

/// By how much a slow ramp overshoots a fold until the motion is gone, with the ramp's sign: with the change r of the
/// parameter in a cycle, 2.338 r^(2/3) (a b)^(-1/3), where -2.338 is the first zero of the Airy function (R. Haberman,
/// SIAM J. Appl. Math. 37, 1979).
double delay_of_ramp(const FoldPassage& fold, double rate);

/// The parameter swings about that of the origin, value + amplitude sin(2 pi t/period), by simulation.
/// @throws InputError for a period that is not positive, and as drive_parameter does
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
/// @param asked_as what stands before names of settings in messages, such as "--"
/// @return a row for each rate, until options.interrupted
/// @throws InputError for a rate that leads away from the point, and as trip_origin and ramped_trip do
std::vector<RampRow> ramped_trips(const LossPoint& point, const std::vector<double>& rates, std::optional<double> from,
                                  const TripEnd& end, const TripOptions& options = {},
                                  const std::string& asked_as = "");

/// Trips about one value of the parameter, at which the motion rests. @return for each amplitude, until
/// options.interrupted
std::vector<TripTime> swung_trips(const LossPoint& point, const TripOrigin& origin,
                                  const std::vector<double>& amplitudes, double period, const TripEnd& end,
                                  const TripOptions& options = {});

} // namespace graze
