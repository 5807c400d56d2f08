#pragma once

#include "graze/results/table.hpp"
#include "graze/trip/disturbed_trip.hpp"
#include "graze/trip/noisy_trip.hpp"
#include "graze/trip/overshoot_trip.hpp"

#include <vector>

namespace graze {

// Numbers of trips that have not come to their end are missing.

/// A row for each overshoot of a touch, or of a fold.
Table trip_table(const OvershootTrips& trips);
/// The trips of two points side by side, with overshoots of the same size.
Table trip_table(const OvershootTrips& one, const OvershootTrips& other);
/// A row for each rate of a ramp.
Table ramp_table(const LossPoint& point, const std::vector<RampRow>& rows);
/// A row for each amplitude of a wave. @param trips for each amplitude, or for the first ones
Table wave_table(const LossPoint& point, const std::vector<double>& amplitudes, const std::vector<TripTime>& trips);
/// A row for each level of noise. @param all for each level, or for the first ones
Table noise_table(const LossPoint& point, const std::vector<double>& levels, const std::vector<NoisyTrips>& all);

} // namespace graze
