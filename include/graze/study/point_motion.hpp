#pragma once

#include "graze/results/stored_run.hpp"

#include <string>
#include <utility>
#include <vector>

namespace graze {

/// The point of a run (which is no branch) whose coordinates are nearest to those asked for, of some directions only
/// unless there are none; the last one if no coordinates are asked for.
/// @param place for messages
/// @throws InputError when there is none
PointRecord chosen_point(const StoredRun& run, const std::vector<std::pair<std::string, double>>& at,
                         const std::vector<std::string>& directions, const Place& place);

/// A motion, with rows so near to one another that a line through them is the curve.
struct DenseMotion {
    std::vector<std::vector<double>> values; ///< for each name that was asked for
    std::vector<std::size_t> begins; ///< rows at which a new arc begins, behind a jump; the first is not among them
    std::vector<std::size_t>
        impacts; ///< rows just before and just after contacts, but not of switches that a clock operates
    std::vector<double> periods; ///< of values that are cyclic states; 0 for others
    double start = 0; ///< time of the first row: later than that of the motion if it was too long to be kept whole
};

/// What becomes of a motion that has more than a million rows.
enum class WhenLong {
    coarser, ///< it is kept whole, with fewer rows in each step
    last     ///< its end is kept
};

/// Whether an event is met by the motion, rather than a switch that a clock operates.
bool is_met_by_motion(const Model& model, const Event& event);

/// A point's motion recomputed densely, step by step: of an orbit one period, of a simulation all of it.
/// @param names of values or expressions; "t" is the time
/// @throws InputError when the file does not say where the motion began
DenseMotion dense_motion(const StoredRun& run, const PointRecord& point, const std::vector<std::string>& names,
                         const Place& place, WhenLong when_long);

} // namespace graze
