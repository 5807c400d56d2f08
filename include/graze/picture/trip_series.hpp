#pragma once

#include "graze/picture/figure.hpp"
#include "graze/trip/disturbed_trip.hpp"
#include "graze/trip/noisy_trip.hpp"
#include "graze/trip/overshoot_trip.hpp"
#include "graze/trip/trip_time.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Adds series of trip times over overshoots: a symbol for each trip, and lines through trips with the same number of
/// contacts. Each further contact adds about one cycle, so that the time is a step function whose steps lie at unknown
/// overshoots. At a fold the time is smooth, and a line joins all trips.
/// @param trips overshoots in rising or falling order, with trips that have ended
/// @param symbol see FigureSeries::symbol
void add_trips(FigurePanel& panel, const std::vector<std::pair<double, TripTime>>& trips, const std::string& title,
               std::size_t colour, int symbol, bool at_fold = false);

/// Times of trips over their overshoots, of one point or of several.
/// @throws InputError without any point
Figure trip_figure(const std::vector<OvershootTrips>& all);

/// Delays of the trips of ramps over their rates. @param end what the trips go to, in words
Figure ramp_figure(const LossPoint& point, const std::vector<RampRow>& rows, const std::string& end);
/// Times of trips over the amplitudes of waves. The distance of the point from the origin is marked.
/// @param trips for each amplitude, or for the first ones
Figure wave_figure(const LossPoint& point, const TripOrigin& origin, const std::vector<double>& amplitudes,
                   const std::vector<TripTime>& trips, const std::string& end);
/// Probabilities of trips over levels of noise. @param all for each level, or for the first ones
Figure noise_figure(const LossPoint& point, const std::vector<double>& levels, const std::vector<NoisyTrips>& all,
                    const NoiseSettings& settings);

} // namespace graze
