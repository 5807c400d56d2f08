#pragma once

#include "graze/study/runner.hpp"
#include "study/shared_file.hpp"

namespace graze {

/// Computes a run of kind orbit or continue from its beginning, and writes it to the file, where it has been begun.
/// @return whether it was finished rather than interrupted
/// @throws InputError when there is nothing to start from
bool run_branch(const Study& study, const StudyRun& run, SharedFile& file, const RunnerOptions& options,
                RunReport& report);

} // namespace graze
