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

/// How far a study has come.
struct StudyProgress {
    std::string run;                              ///< of which a point has been computed,
    std::size_t done = 0, points = 0;             ///< and how many of its points there are now, and will be
    std::size_t study_done = 0, study_points = 0; ///< the same of all runs but branches
    std::size_t computed = 0;                     ///< of `study_done`, those that were not in the file before
    /// Runs of kind orbit and continue that have not ended: nobody knows how long they take.
    std::size_t branches_left = 0;
};

struct RunnerOptions {
    int jobs = 1;                  ///< threads: of one run, and runs that do not start from one another side by side
    bool one_by_one = false;       ///< runs wait for one another, though each uses all threads that it can
    std::vector<std::string> only; ///< names of runs, with those they start from; empty: all
    std::function<bool()> interrupted;
    /// After each point.
    std::function<void(const StudyProgress& progress)> progress;
    /// Each orbit of a run of kind orbit or continue, as it is found; those of different runs may take turns.
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
/// In how many chains, which can be computed side by side.
std::size_t chains_of(const StudyRun& run);
/// Points of a run: chains along its first axis, one for each combination of the others.
/// @param run is copied
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
/// Results, and their order in the file, do not depend on the number of threads.
/// @return reports of the runs, in the order of the study; when it was interrupted, some may be unfinished, and those
///         that were not begun are missing
/// @throws InputError when the file cannot be written; what a callback throws
std::vector<RunReport> run_study(const Study& study, ResultFile& file, const RunnerOptions& options);

} // namespace graze
