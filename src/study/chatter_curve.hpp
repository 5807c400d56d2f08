#pragma once

#include "graze/flow/system.hpp"
#include "graze/study/runner.hpp"
#include "study/branch_part.hpp"

namespace graze {

/// Follows an onset of chatter in two parameters, past turns in either. A run of kind curve.
/// @return whether it was finished rather than interrupted
/// @throws InputError when none is found at the first point
bool run_chatter_curve(const StudyRun& run, const System& system, const SpecialPoint& first, PointWriter& writer,
                       const RunnerOptions& options);

} // namespace graze
