#pragma once

#include "study/branch_part.hpp"

namespace graze {

/// Carries out a run of kind torus: follows the tori that begin at a torus point.
/// @param first the torus point of the run that it starts from
/// @return whether it was finished rather than interrupted
/// @throws InputError when no tori begin there
bool run_torus(const StudyRun& run, const System& system, const OrbitRecord& first, PointWriter& writer,
               const RunnerOptions& options);

} // namespace graze
