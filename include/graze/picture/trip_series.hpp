#pragma once

#include "graze/picture/figure.hpp"
#include "graze/trip/overshoot_trip.hpp"
#include "graze/trip/trip_time.hpp"

#include <utility>
#include <vector>

namespace graze {

/// Times until trips at overshoots. Each contact more adds a cycle or so: times are steps, and where steps end between
/// two overshoots nobody has computed. So there is a symbol for each trip, and a line only through those with as many
/// contacts. At a fold a line goes through all, for there the time is smooth.
/// @param trips overshoots, from the least or the greatest on, with trips that have come to their end
/// @param symbol as FigureSeries has it
void add_trips(FigurePanel& panel, const std::vector<std::pair<double, TripTime>>& trips, const std::string& title,
               std::size_t colour, int symbol, bool at_fold = false);

/// Times of trips over their overshoots, of one point or of several.
/// @throws InputError without any point
Figure trip_figure(const std::vector<OvershootTrips>& all);

} // namespace graze
