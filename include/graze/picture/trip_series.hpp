#pragma once

#include "graze/picture/figure.hpp"
#include "graze/trip/overshoot_trip.hpp"
#include "graze/trip/trip_time.hpp"

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

} // namespace graze
