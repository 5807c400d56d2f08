#pragma once

#include "study/branch_part.hpp"

namespace graze {

/// Computes a run of kind equilibrium: the equilibria in a box, or the one near an initial state, the last state of a
/// motion, or an orbit of another run.
/// @return whether it was finished rather than interrupted
bool run_equilibrium(const Study& study, const StudyRun& run, const System& system, SharedFile& file,
                     const RunnerOptions& options, RunReport& report, PointWriter& writer);

} // namespace graze
