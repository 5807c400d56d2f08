#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"
#include "graze/sweep/plan.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Progress of a study.
struct StudyProgress {
    std::string run;                              ///< the run of which a point has just been computed
    std::size_t done = 0, points = 0;             ///< points of this run: computed, planned
    std::size_t study_done = 0, study_points = 0; ///< the same for all runs except branches
    std::size_t computed = 0;                     ///< those of `study_done` that were not in the file before
    /// Runs of orbits and branches that have not ended. Their number of points is not known beforehand.
    std::size_t branches_left = 0;
};

struct RunnerOptions {
    int jobs = 1;                        ///< threads, shared by runs that are independent and by the chains of each run
    bool one_by_one = false;             ///< runs follow one another, each with all threads that it can use
    std::vector<std::string> only{};     ///< names of runs; those that they need are done as well; empty: all runs
    std::function<bool()> interrupted{}; ///< true stops the study
    /// Called after each point.
    std::function<void(const StudyProgress& progress)> progress{};
    /// Called with each orbit of a branch as it is found. Orbits of runs that go on side by side alternate.
    std::function<void(const std::string& run, const OrbitRecord& orbit)> orbit{};
};

enum class RunOutcome {
    complete,
    interrupted,
    failed,  ///< for example no orbit was found: `problem` says why, `remedy` what to do
    skipped, ///< a run that it needs failed
    partial, ///< the rest, or a run that it needs, is left to others; see Elsewhere
};

/// "complete", "interrupted", "failed", "skipped" or "partial".
std::string_view name_of(RunOutcome outcome);

/// The outcome of one run.
struct RunReport {
    std::string name, kind;
    std::size_t points = 0, computed = 0; ///< planned points; points computed now rather than found in the file
    std::size_t returns = 0;              ///< returns to the section that were simulated now
    double seconds = 0;
    RunOutcome outcome = RunOutcome::complete;
    std::string problem, remedy; ///< of a run that failed or was skipped

    bool complete() const { return outcome == RunOutcome::complete; }
};

/// Number of points of a run that are known beforehand: those of motions, or the records. A branch or an estimate
/// counts as one.
std::size_t points_of(const StudyRun& run);
/// Number of chains of points, which can be computed side by side; 1 for runs without motions.
std::size_t chains_of(const StudyRun& run);
/// The points of a run: chains along its first axis, one for each combination of the values of the other axes.
/// @param run is copied
/// @param system of the run's model
/// @param start at which the run begins; null: it begins at the model's initial state
Plan plan_of(const StudyRun& run, const System& system, const PointRecord* start);
/// Coordinates of a point of the plan, which are the values of the axes, and its direction (0: the first one).
std::vector<double> coordinates_of(const StudyRun& run, std::size_t point);
std::size_t direction_of(const StudyRun& run, std::size_t point);

/// Carries out a study and stores its results. Complete runs whose settings have not changed are kept, unfinished runs
/// are continued (branches, which take little time, begin again), and others are computed anew. The file then has all
/// that is needed to repeat the study (`stored_study`). A run that fails does not stop runs that do not need it.
/// Results, and their order in the file, do not depend on the number of threads.
/// @return reports of the runs, in the order of the study; of an interrupted study some runs may be unfinished, and
/// runs
///         that were not begun are missing
/// @throws InputError when the file cannot be written; what a callback throws
std::vector<RunReport> run_study(const Study& study, ResultFile& file, const RunnerOptions& options);

} // namespace graze
