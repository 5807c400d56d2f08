#pragma once

#include "graze/flow/system.hpp"
#include "graze/study/runner.hpp"
#include "study/branch_part.hpp"

namespace graze {

/// Climbs from a grazing to the next, with one contact more each time, and adds where that leads: a run of kind ladder.
/// @param first the grazing of the run that it starts from
/// @return whether it was finished rather than interrupted
/// @throws InputError when nothing can be climbed from there
bool run_ladder(const StudyRun& run, const System& system, const OrbitRecord& first, PointWriter& writer,
                const RunnerOptions& options);

} // namespace graze
