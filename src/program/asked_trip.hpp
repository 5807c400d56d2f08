#pragma once

#include "graze/results/touching_orbit.hpp"
#include "graze/trip/overshoot_trip.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"
#include "program/table.hpp"

#include <string>
#include <vector>

namespace graze {

/// The point of a file of which trips are asked about.
struct AskedTrip {
    StoredOrbit stored;
    LossPoint point;
    NamedEnd end;
};
/// @param option where the point was asked for, for messages
/// @throws InputError as loss_point does, and for what names no level
AskedTrip asked_trip(const ResultFile& file, const std::string& point, const TripArguments& arguments,
                     const std::string& option);

/// Numbers of a list, or of FIRST:LAST one for each decade. @param option in which they are written
/// @throws InputError for what are none, or too many
std::vector<double> numbers_by_decades(const Model& model, const std::vector<std::string>& asked,
                                       const std::string& option);

/// Why a trip has not come to its end, and what to do. @param longer what to do where more cycles may help
std::string why_not(const TripTime& trip, const std::string& longer);
/// The first of what has not come to its end, and how many more there are, each on a line.
void tell_lacks(const std::vector<std::string>& lacks, const Console& console);

/// What a JSON table says of the point first.
JsonObject heading_of(const ResultFile& file, const AskedTrip& asked);

} // namespace graze
