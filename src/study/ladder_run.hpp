#pragma once

#include "graze/flow/system.hpp"
#include "graze/study/runner.hpp"
#include "study/branch_part.hpp"

#include <vector>

namespace graze {

/// Monitors of a motion over many contacts. Unknown where they name segments that it has not.
std::vector<double> monitors_of(const System& system, const Orbit& orbit, const StudyRun& run);

/// Climbs from a grazing to the next, with one contact more each time, and adds where that leads: a run of kind ladder.
/// @param first the grazing of the run that it starts from
/// @return whether it was finished rather than interrupted
/// @throws InputError when nothing can be climbed from there
bool run_ladder(const StudyRun& run, const System& system, const OrbitRecord& first, PointWriter& writer,
                const RunnerOptions& options);

} // namespace graze
