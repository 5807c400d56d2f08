#pragma once

#include "graze/study/runner.hpp"

#include <string>
#include <vector>

namespace graze {

/// What has come of putting parts together.
struct MergedParts {
    std::vector<RunReport> reports{};   ///< a run is `partial` if points, or a run that it needs, are missing
    std::vector<std::string> missing{}; ///< sentences on what is not there, and why, and on files of no use
    bool complete() const { return missing.empty(); }
};

/// Puts the results of parts of a study (run_part) into one file, which then is the same as if one process had computed
/// them, bit for bit except for times. Parts may be of several divisions, be repeated, unfinished or missing: what is
/// there is taken, and run_study, or parts that begin with this file, compute the rest.
/// @param file may have results already: what is complete there stays
/// @throws InputError as run_study
MergedParts merge_parts(const Study& study, const std::vector<ResultFile>& parts, ResultFile& file,
                        const RunnerOptions& options);

} // namespace graze
