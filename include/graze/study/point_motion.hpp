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

/// A point's motion recomputed densely: of an orbit one period, of a simulation all of it.
/// @param names of values or expressions; "t" is the time
/// @return for each name its values; where a jump happened, before and after
/// @throws InputError when the file does not say where the motion began
std::vector<std::vector<double>> dense_motion(const StoredRun& run, const PointRecord& point,
                                              const std::vector<std::string>& names, const Place& place);

} // namespace graze
