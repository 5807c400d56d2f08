#include "page/study_job.hpp"

#include "graze/atlas/run_atlas.hpp"
#include "graze/results/query_interruption.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/stored_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>

namespace graze {

namespace {

void make_folder_of(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code error;
    if (!folder.empty())
        std::filesystem::create_directories(folder, error);
    if (error)
        throw FileError(folder.string(), fmt::format("the folder cannot be made ({})", error.message()),
                        "look at the permissions of its folder");
}

/// @param runs that were asked for; without a report one was not even begun
JobEnd end_of(const std::vector<RunReport>& reports, const std::vector<std::string>& runs) {
    JobEnd end;
    for (const std::string& name : runs)
        end.interrupted = end.interrupted || std::ranges::find(reports, name, &RunReport::name) == reports.end();
    for (const RunReport& report : reports) {
        end.interrupted = end.interrupted || report.outcome == RunOutcome::interrupted;
        if (report.outcome == RunOutcome::failed || report.outcome == RunOutcome::skipped)
            end.failure += fmt::format("{}run '{}' {}: {}; {}", end.failure.empty() ? "" : "\n", report.name,
                                       name_of(report.outcome), report.problem, report.remedy);
    }
    return end;
}

/// True when a request to stop has lasted for seconds.
std::function<bool()> long_requested(const std::function<bool()>& interrupted) {
    using Clock = std::chrono::steady_clock;
    return [interrupted, since = std::optional<Clock::time_point>()]() mutable {
        if (!interrupted())
            return false;
        if (!since)
            since = Clock::now();
        return Clock::now() - *since > std::chrono::seconds(2);
    };
}

/// After a failure, as of a full disk, fewer points of the run may be stored than were computed.
void tell_kept_points(const StudySession& session, const Study& study, const std::string& run,
                      const JobControl& control) {
    const StudyRun* told = study.find_run(run);
    if (told == nullptr)
        return;
    try {
        if (const auto file = session.results())
            control.progress(run, file->point_count(run),
                             told->is_branch() ? std::nullopt : std::optional(points_of(*told)));
    } catch (const InputError&) { // NOLINT(bugprone-empty-catch): the failure before it is told
    }
}

} // namespace

JobEnd compute_runs(const StudySession& session, const std::vector<std::string>& runs, const JobControl& control,
                    int threads) {
    // Of its own: atlases add runs to it.
    const auto study = std::make_shared<Study>(*session.faultless_study());
    for (const std::string& name : runs)
        if (study->find_run(name) == nullptr)
            throw InputError(fmt::format("the study has no run '{}' any more", name), "add it again");
    make_folder_of(session.results_path());
    ResultFile file(session.results_path(), ResultFile::Access::write);
    if (other_set(*study, file))
        throw InputError(Place{file.path(), 0, 0}, "the results there were made with other values of parameters",
                         "compute the study in another folder");
    RunnerOptions options;
    options.jobs = threads;
    options.only = runs;
    options.interrupted = control.interrupted;
    std::string last_told;
    options.progress = [&](const StudyProgress& made) {
        const StudyRun* const run = study->find_run(made.run);
        last_told = made.run;
        if (run != nullptr && !run->is_branch())
            control.progress(made.run, made.done, made.points);
    };
    std::map<std::string, std::size_t> orbits;
    options.orbit = [&](const std::string& run, const OrbitRecord&) {
        last_told = run;
        control.progress(run, ++orbits[run], std::nullopt);
    };
    // A file that was made to have endless queries must not keep the server from ending; others go on to write.
    const QueryInterruption stoppable(long_requested(control.interrupted));
    try {
        return end_of(run_with_atlases(*study, file, options,
                                       [](const Study& all, ResultFile& to, const RunnerOptions& now) {
                                           return run_study(all, to, now);
                                       }),
                      runs);
    } catch (...) {
        tell_kept_points(session, *study, last_told, control);
        throw;
    }
}

} // namespace graze
