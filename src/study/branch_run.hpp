#pragma once

#include "graze/study/runner.hpp"

namespace graze {

/// Computes a run of kind orbit or continue from its beginning, and writes it to the file, where it has been begun.
/// @return whether it was finished rather than interrupted
/// @throws InputError when there is nothing to start from
bool run_branch(const Study& study, const StudyRun& run, ResultFile& file, const RunnerOptions& options,
                RunReport& report);

/// The point of an earlier run of kind orbit or continue that another one starts from.
/// @throws InputError when there is none
OrbitRecord orbit_to_start_from(const StartFrom& start, const StudyRun& parent, const ResultFile& file);

/// The point of an earlier run of another kind. @throws InputError when there is none, or no state to start from
PointRecord point_to_start_from(const StudyRun& run, const Study& study, const ResultFile& file);

/// Ways in which a run of kind continue, or a sweep, goes.
std::vector<std::string> direction_names(const StudyRun& run);

} // namespace graze
