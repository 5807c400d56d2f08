#pragma once

#include "graze/branch/located_value.hpp"
#include "graze/design/design.hpp"
#include "graze/grazing/cycle_map.hpp"
#include "graze/results/result_file.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Returns the study whose runs lead to a design's trip point: generated, or the one that the design names, without
/// other runs.
/// @throws InputError with the design's place
Study approach_study(const Design& design);

/// A special point that the device passes on the branch to its trip point.
struct EarlierPoint {
    std::string run, label, detail;
    PointType type = PointType::regular;
    double value = 0;     ///< value of the control parameter
    bool changes = false; ///< the motion changes there, so the device may trip there first
    SpecialPoint point{};
};

/// A trip point: a grazing, or another point whose condition can be continued, such as a fold.
struct TripPoint {
    System system;
    SpecialPoint point;
    ParameterId control;
    std::string run, label;
    std::vector<EarlierPoint> earlier; ///< earlier points, in the order of the branches
    int fold_side = 1;                 ///< at a fold: side of the control parameter without an orbit, 1 above, -1 below

    double value() const { return point.solution.orbit.parameters[control.place()]; }
    bool is_touch() const { return point.type == PointType::grazing; }
};

/// Finds the trip point in the results of the approach's study.
/// @throws InputError when the branch ended before it, with what happened instead
TripPoint find_trip_point(const Design& design, const Study& study, const ResultFile& file);

/// Class of a trip point, by the map of the cycle.
struct TripClass {
    GrazingOutcome outcome = GrazingOutcome::undecided;
    std::string reason;          ///< why it is undecided, or has no map
    std::optional<CycleMap> map; ///< map of the cycle at a touch
    Verdict verdict;             ///< verdict of the map
};
/// Returns the designers' name of a class: "trips", "persists", "folds" or "undecided".
std::string_view class_name(GrazingOutcome outcome);

/// Returns the trip point of a device with other parameters, whose orbit is known (LocatedSolution). A touch that has
/// moved to another segment is found again; earlier points are unknown.
TripPoint moved_to(const TripPoint& trip, const Orbit& orbit);
TripClass class_at(const TripPoint& trip);

} // namespace graze
