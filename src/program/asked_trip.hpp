#pragma once

#include "graze/results/touching_orbit.hpp"
#include "graze/trip/overshoot_trip.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"
#include "program/table.hpp"

#include <string>
#include <vector>

namespace graze {

/// The point of a file at which trips begin, and their end.
struct AskedTrip {
    StoredOrbit stored;
    LossPoint point;
    NamedEnd end;
};
/// @param option where the point was asked for, for messages
/// @throws InputError as loss_point does, and for an end that names no level
AskedTrip asked_trip(const ResultFile& file, const std::string& point, const TripArguments& arguments,
                     const std::string& option);

/// Reads numbers of a list; FIRST:LAST stands for one number in each decade. @param option in which they are written
/// @throws InputError for texts that are no numbers, and for too many numbers
std::vector<double> numbers_by_decades(const Model& model, const std::vector<std::string>& asked,
                                       const std::string& option);

/// Tells why a trip has not come to its end, and what to do. @param longer the remedy where more cycles may help
std::string why_not(const TripTime& trip, const std::string& longer);
/// Prints the first of these messages about trips without an end, and how many more there are.
void tell_lacks(const std::vector<std::string>& lacks, const Console& console);

/// The heading of a table of trips in JSON: the point and the end.
JsonObject heading_of(const ResultFile& file, const AskedTrip& asked);

} // namespace graze
