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

/// The study whose runs lead to a design's trip point: its own, or that which it names. Runs other than those needed
/// are left out.
/// @throws InputError with the design's place
Study approach_study(const Design& design);

/// A point that the device passes on the way to its trip point.
struct EarlierPoint {
    std::string run, label, detail;
    PointType type = PointType::regular;
    double value = 0;     ///< of the control parameter
    bool changes = false; ///< the motion beyond it is another one: the device may trip there first
    SpecialPoint point{};
};

/// Where the device trips: a touch, or another point whose condition can be held, as a fold.
struct TripPoint {
    System system;
    SpecialPoint point;
    ParameterId control;
    std::string run, label;
    std::vector<EarlierPoint> earlier; ///< in the order of the branches
    int fold_side = 1; ///< of the control parameter on which there is no orbit, at a fold: 1 above, -1 below

    double value() const { return point.solution.orbit.parameters[control.place()]; }
    bool is_touch() const { return point.type == PointType::grazing; }
};

/// The trip point in the results of the approach's study.
/// @throws InputError when the branch ended without it: says what happened instead
TripPoint find_trip_point(const Design& design, const Study& study, const ResultFile& file);

/// What happens at a trip point, by the map of the cycle.
struct TripClass {
    GrazingOutcome outcome = GrazingOutcome::undecided;
    std::string reason;          ///< why undecided, or why without a map
    std::optional<CycleMap> map; ///< of a touch
    Verdict verdict;             ///< of that
};
/// "trips", "persists", "folds" or "undecided", as designers say.
std::string_view class_name(GrazingOutcome outcome);

/// The trip point of a neighbour with other parameters, whose orbit is known (LocatedSolution). A touch that has left
/// its segment is found again; what comes earlier there is not known.
TripPoint moved_to(const TripPoint& trip, const Orbit& orbit);
TripClass class_at(const TripPoint& trip);

} // namespace graze
