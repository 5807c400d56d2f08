#pragma once

#include "graze/study/run_part.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A run of motions whose points somebody else is asked for.
struct AskedPoints {
    const PartedRun& run;
    const std::string& fingerprint;    ///< of the run, see RunRecord
    const KnownChains& known;          ///< what of its chains is there
    int jobs;                          ///< threads that may be used
    std::function<bool()> interrupted; ///< asked now and then; true: it has to end soon
};

/// A run of another kind that somebody else is asked for.
struct AskedResults {
    const StudyRun& run;
    const std::string& fingerprint; ///< of the run, see RunRecord
    std::function<bool()> interrupted;
};

/// Computes points of a run of motions in some other way than by threads of this process.
/// @param sink receives points that are not there, in order within each chain; called by one thread at a time. Points
/// that it does not receive are left to others: the run stays unfinished.
/// @return false when it was interrupted
using PointsElsewhere = std::function<bool(const AskedPoints& asked, const PointSink& sink)>;

/// Finds the results of a run of orbits, records or estimates. @return a file that has the run, complete or failed,
/// with this fingerprint; none: they are left to others, and the run stays unfinished
using ResultsElsewhere = std::function<std::optional<ResultFile>(const AskedResults& asked)>;

/// Who computes the runs of a study. What is empty is computed by threads of this process.
struct Elsewhere {
    PointsElsewhere points{};
    ResultsElsewhere results{};
    /// How many points of a run will be received or are there, for the progress. Empty: all.
    std::function<std::size_t(const StudyRun& run)> expected{};
    /// Runs take no thread of this process, but for the one that waits: RunnerOptions::jobs of them go on side by side.
    bool only_waits = false;
};

/// The same as run_study, but runs are computed elsewhere. The file is the same, too.
std::vector<RunReport> run_study(const Study& study, ResultFile& file, const RunnerOptions& options,
                                 const Elsewhere& elsewhere);

} // namespace graze
