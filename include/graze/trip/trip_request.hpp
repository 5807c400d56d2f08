#pragma once

#include "graze/model/model.hpp"
#include "graze/trip/disturbed_trip.hpp"
#include "graze/trip/noisy_trip.hpp"
#include "graze/trip/overshoot_trip.hpp"

#include <string>
#include <vector>

namespace graze {

/// Reads numbers, or expressions in the model's parameters; FIRST:LAST stands for one number in each decade.
/// @param option in which they are written, for messages
/// @throws InputError for texts that are no numbers, and for too many numbers
std::vector<double> numbers_by_decades(const Model& model, const std::vector<std::string>& items,
                                       const std::string& option);

/// Reads what ends trips: EXPR=LEVEL, or `end`: where the motion itself ends (of a touch the limit of the map).
/// @param option in which it is written, for messages
/// @throws InputError for other texts
NamedEnd read_end(const LossPoint& point, const std::string& text, const std::string& option);

/// Tells why a trip has not come to its end, and what to do. @param longer the remedy where more cycles may help
std::string why_not(const TripTime& trip, const std::string& longer);

/// Messages about trips that have not come to their end. @param longer the remedy where more cycles may help
std::vector<std::string> unfinished_trips(const OvershootTrips& trips, const std::string& longer);
std::vector<std::string> unfinished_trips(const std::vector<RampRow>& rows, const std::string& longer);
/// The same for waves, which may well pass without a trip. @param trips for each amplitude, or for the first ones
std::vector<std::string> unfinished_trips(const std::vector<double>& amplitudes, const std::vector<TripTime>& trips);
/// The same for motions under noise that are not counted. @param all for each level, or for the first ones
std::vector<std::string> unfinished_trips(const std::vector<double>& levels, const std::vector<NoisyTrips>& all);

} // namespace graze
