#pragma once

#include "graze/flow/system.hpp"
#include "graze/study/runner.hpp"
#include "study/branch_part.hpp"

#include <vector>

namespace graze {

/// Monitors of the orbit at an onset of chatter. Unknown (NaN) where they name segments that the orbit does not have.
std::vector<double> monitors_of(const System& system, const Orbit& orbit, const StudyRun& run);

/// Carries out a run of kind ladder: climbs from grazing to grazing, with one more contact each time, and adds the
/// limit.
/// @param first the grazing of the run that it starts from
/// @return whether it was finished rather than interrupted
/// @throws InputError when nothing can be climbed from there
bool run_ladder(const StudyRun& run, const System& system, const OrbitRecord& first, PointWriter& writer,
                const RunnerOptions& options);

} // namespace graze
