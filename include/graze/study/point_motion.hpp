#pragma once

#include "graze/results/stored_run.hpp"
#include "graze/trajectory/outcome.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// The point of a run, not of a branch, whose coordinates are nearest to the given ones; the last point if none are
/// given.
/// @param directions only points of these directions count; empty: all
/// @param place for messages
/// @throws InputError when there is none
PointRecord chosen_point(const StoredRun& run, const std::vector<std::pair<std::string, double>>& at,
                         const std::vector<std::string>& directions, const Place& place);

/// A motion, with rows so close together that straight lines between them look like the curve.
struct DenseMotion {
    std::vector<std::vector<double>> values; ///< for each name that was asked for
    std::vector<std::size_t> begins;         ///< rows at which a new arc begins after a jump; row 0 is not among them
    std::vector<std::size_t> impacts;        ///< rows just before and just after contacts, except events of time alone
    std::vector<std::size_t> met;            ///< the event of each row of `impacts`; only of dense_motion
    std::vector<std::size_t> modes;          ///< mode of each arc: of the first, then of those in `begins`
    std::vector<double> periods;             ///< of values that are cyclic states; 0 for others
    double start = 0; ///< time of the first row: later than that of the motion if it was too long to be kept whole
    Outcome outcome;  ///< how the motion ended
};

/// How a motion with more than a million rows, or with more than 16 million values, is shortened.
enum class WhenLong {
    coarser, ///< all of it is kept, with fewer rows in each step
    last     ///< only its end is kept
};

/// The contacts that a picture marks where nothing is chosen: those with barriers that the motion meets.
std::vector<bool> usual_marks(const Model& model);

/// Computes the motion of a point again, with several rows in each step: of an orbit one period, of a simulation all.
/// @param names of values or expressions; "t" is the time
/// @param interrupted asked after each step; true ends the motion there, with Ending::stopped, as QueryInterruption
/// does
/// @throws InputError when the file does not say where the motion began
DenseMotion dense_motion(const StoredRun& run, const PointRecord& point, const std::vector<std::string>& names,
                         const Place& place, WhenLong when_long, const std::function<bool()>& interrupted = {});

} // namespace graze
