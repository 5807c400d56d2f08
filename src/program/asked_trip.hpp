#pragma once

#include "graze/results/touching_orbit.hpp"
#include "graze/trip/trip_request.hpp"
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

/// Prints the first of messages about trips without an end, and how many more there are.
void tell_lacks(const std::vector<std::string>& lacks, const Console& console);

/// The heading of a table of trips in JSON: the point and the end.
JsonObject heading_of(const ResultFile& file, const AskedTrip& asked);

} // namespace graze
