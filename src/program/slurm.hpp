#pragma once

#include "graze/study/study.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

#include <string>

namespace graze {

/// Computes a study in parts by an array of SLURM's jobs, waits for them, and puts the parts together; then once more
/// for runs that had to wait for all parts of others. Parts that have ended, or are in SLURM's queue, are not submitted
/// again.
/// @param folder of results and pictures; machines of the cluster have it, too
/// @param file of the results
/// @return the exit code
int run_by_slurm(const Study& study, const std::string& folder, const std::string& file, const RunArguments& arguments,
                 const Console& console);

} // namespace graze
