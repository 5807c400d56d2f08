#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"
#include "graze/sweep/plan.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace graze {

struct RunnerOptions {
    int jobs = 1;
    std::vector<std::string> only;     ///< names of runs, with those they start from; empty: all
    std::function<bool()> interrupted; ///< called from any thread
    /// Points of all runs done so far, and in all; of the run in progress its name. Called from one thread at a time.
    std::function<void(const std::string& run, std::size_t done, std::size_t all)> progress;
    /// Each orbit of a run of kind orbit or continue, as it is found.
    std::function<void(const std::string& run, const OrbitRecord& orbit)> orbit;
};

enum class RunOutcome {
    complete,
    interrupted,
    failed,  ///< nothing to start from, or no orbit found: `problem` says what, and `remedy` what to do
    skipped, ///< the run that it starts from failed
};

/// What has become of one run.
struct RunReport {
    std::string name, kind;
    std::size_t points = 0, computed = 0; ///< planned; computed now rather than found in the file
    std::size_t returns = 0;              ///< simulated now
    double seconds = 0;
    RunOutcome outcome = RunOutcome::complete;
    std::string problem, remedy; ///< of a run that failed or was skipped

    bool complete() const { return outcome == RunOutcome::complete; }
};

/// How many points a run has.
std::size_t points_of(const StudyRun& run);
/// Points of a run: chains along its first axis, one for each combination of the others.
/// @param run must outlive the plan
/// @param system of the run's model
/// @param start where the run begins, instead of at the model's initial state; may be null
Plan plan_of(const StudyRun& run, const System& system, const PointRecord* start);
/// Coordinates and direction of a point of that plan: what its axes have there.
std::vector<double> coordinates_of(const StudyRun& run, std::size_t point);
std::size_t direction_of(const StudyRun& run, std::size_t point);

/// Does what a study asks for, and keeps it. Complete runs whose settings have not changed are left as they are,
/// unfinished ones are gone on with (branches, which take little time, begun again), and others are done anew.
/// The file then has all that is needed to do so again (`stored_study`). Runs that fail do not keep those from being
/// done that do not start from them.
/// @return reports of the runs, in their order; the last may be unfinished when it was interrupted
/// @throws InputError when the file cannot be written
std::vector<RunReport> run_study(const Study& study, ResultFile& file, const RunnerOptions& options);

} // namespace graze
