#pragma once

#include "graze/branch/fold_passage.hpp"
#include "graze/grazing/trip_time.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"
#include "program/table.hpp"
#include "program/touching_orbit.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A point of a branch beyond which the motion is lost: a touch whose contacts grow, or a fold.
struct LossPoint {
    StoredOrbit stored;
    System system;
    ParameterId parameter; ///< that moves the orbit
    std::string name;      ///< of that
    std::string unit;
    double value = 0;  ///< of that at the point
    int side = 0;      ///< on which the motion is lost: 1 above, -1 below
    double cycle = 0;  ///< time of one
    double level = 0;  ///< of a touch: approach speed up to which the map of the cycle tells of contacts
    CycleMap map{};    ///< of a touch
    Verdict verdict{}; ///< of a touch
    std::optional<FoldPassage> fold{}; ///< none: it is a touch

    const Model& model() const { return stored.run.model; }
    const char* kind() const { return fold ? "fold" : "touch"; }
};

/// @param option where it was asked for, for messages
/// @throws InputError where there is no such point, nothing is touched and it is no fold, and where the motion is not
///         lost there
LossPoint loss_point(const ResultFile& file, const std::string& point, const std::string& parameter,
                     const std::string& option);

/// What ends a trip, for people too.
struct AskedEnd {
    TripEnd end;
    std::string words;
    bool given = false; ///< rather than what is usual at such a point
};
/// @throws InputError for what names no level
AskedEnd end_of(const LossPoint& point, const TripArguments& arguments);

/// Numbers of a list, or of FIRST:LAST one for each decade. @param option in which they are written
/// @throws InputError for what are none, or too many
std::vector<double> numbers_by_decades(const Model& model, const std::vector<std::string>& asked,
                                       const std::string& option);

/// Why a trip has not come to its end, and what to do. @param longer what to do where more cycles may help
std::string why_not(const TripTime& trip, const std::string& longer);
/// The first of what has not come to its end, and how many more there are, each on a line.
void tell_lacks(const std::vector<std::string>& lacks, const Console& console);

/// What a JSON table says of the point first.
JsonObject heading_of(const ResultFile& file, const LossPoint& point, const AskedEnd& end);

} // namespace graze
