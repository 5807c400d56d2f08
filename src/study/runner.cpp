#include "graze/study/runner.hpp"

#include "base/enumerator_name.hpp"
#include "base/turns.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/elsewhere.hpp"
#include "graze/study/escape_rates.hpp"
#include "graze/study/run_times.hpp"
#include "graze/study/stored_study.hpp"
#include "study/branch_run.hpp"
#include "study/copied_run.hpp"
#include "study/measured_run.hpp"
#include "study/plan_of_run.hpp"
#include "study/run_record.hpp"
#include "study/run_schedule.hpp"
#include "study/shared_file.hpp"
#include "study/start_point.hpp"
#include "study/stored_progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <set>

namespace graze {

std::string_view name_of(RunOutcome outcome) {
    constexpr std::string_view names[] = {"complete", "interrupted", "failed", "skipped", "partial"};
    return enumerator_name(names, outcome, "failed");
}

namespace {

/// Carries out the runs of a study, independent ones side by side. Its members are read and changed only by the thread
/// that holds the file.
class Runner {
public:
    Runner(const Study& study, ResultFile& file, const RunnerOptions& options, const Elsewhere& elsewhere)
        : study_(&study), path_(file.path()), file_(file), options_(options), elsewhere_(elsewhere) {
        const auto interrupted = turns_.asking(options.interrupted);
        options_.interrupted = [this, interrupted] { return broken_off_ || (interrupted && interrupted()); };
        options_.progress = turns_.taking(options.progress);
        options_.orbit = turns_.taking(options.orbit);
        const std::set<std::string> wanted = wanted_runs(study, options.only);
        for (const StudyRun& run : study.runs)
            if (wanted.contains(run.name)) {
                runs_.push_back(&run);
                (run.is_branch() ? progress_.branches_left : progress_.study_points) += expected_points(run);
            }
    }

    std::vector<RunReport> run() {
        std::vector<ScheduledRun> schedule;
        for (const StudyRun* run : runs_) {
            ScheduledRun& one = schedule.emplace_back();
            one.threads = elsewhere_.only_waits ? 1 : chains_of(*run);
            for (std::size_t r = 0; r + 1 < schedule.size(); ++r)
                for (const auto& need : run->needs())
                    if (runs_[r]->name == need.first)
                        one.after.push_back(r);
        }
        reports_.resize(runs_.size());
        if (options_.one_by_one)
            for (std::size_t run = 0; run < runs_.size() && !stopped_; ++run)
                do_one(run, options_.jobs);
        else
            run_side_by_side(
                schedule, options_.jobs, [this] { return stopped_.load(); },
                [this](std::size_t run, int threads) { do_one(run, threads); });
        std::vector<RunReport> begun;
        for (std::optional<RunReport>& report : reports_)
            if (report)
                begun.push_back(std::move(*report));
        return begun;
    }

private:
    using Clock = std::chrono::steady_clock;

    /// The state of a run that is being carried out.
    struct Work {
        RunReport report;
        int threads = 1;
        std::size_t counted = 0;       ///< number of its points that the progress has counted
        std::optional<RunTimes> times; ///< none: it computes nothing
    };

    /// Number of its points that this process will have at its end.
    std::size_t expected_points(const StudyRun& run) const {
        return elsewhere_.expected ? elsewhere_.expected(run) : points_of(run);
    }

    void do_one(std::size_t index, int threads) {
        const StudyRun& run = *runs_[index];
        const auto begun = Clock::now();
        Work work;
        work.threads = threads;
        try {
            attempt(run, work);
            work.report.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
            file_.with([&](ResultFile& file) { end(run, work, file); });
        } catch (...) {
            broken_off_ = stopped_ = true; // all other runs end too
            throw;
        }
        if (work.report.outcome == RunOutcome::interrupted)
            stopped_ = true;
        reports_[index] = std::move(work.report);
    }

    void end(const StudyRun& run, Work& work, ResultFile& file) {
        if (run.is_branch())
            --progress_.branches_left;
        else
            progress_.study_done += std::max(expected_points(run), work.counted) - work.counted;
        if (!work.report.problem.empty())
            file.fail_run(run.name, work.report.problem + "; " + work.report.remedy);
        if (!work.times)
            return;
        work.times->seconds += work.report.seconds;
        if (work.report.outcome != RunOutcome::interrupted)
            work.times->ended = present_time();
        note_times(file, run.name, *work.times);
    }

    /// Carries out a run. A failure is reported, and runs that do not need this one go on.
    void attempt(const StudyRun& run, Work& work) {
        work.report.name = run.name;
        work.report.kind = name_of(run.kind);
        const bool skipped = file_.with([&](ResultFile& file) {
            for (const auto& need : run.needs())
                if (partial_.contains(need.first)) {
                    leave(run, work.report);
                    return true;
                } else if (failed_.contains(need.first)) {
                    fail(run, work.report, file, RunOutcome::skipped,
                         run.start && run.start->run == need.first
                             ? fmt::format("run '{}', from which it starts, failed", need.first)
                             : fmt::format("run '{}', which it needs, failed", need.first),
                         "mend that one first");
                    return true;
                }
            return false;
        });
        if (skipped)
            return;
        try {
            if (run.is_measured())
                do_measured(run, work);
            else
                run.is_branch() ? do_branch(with_found(run), work) : do_points(with_found(run), work);
        } catch (const InputError& error) {
            turns_.rethrow();                // a callback has thrown: that ends all runs
            if (error.place().file == path_) // the file cannot be written, by other runs neither
                throw;
            file_.with([&](ResultFile& file) {
                file.flush();
                const std::string place = error.place().text();
                fail(run, work.report, file, RunOutcome::failed, place + (place.empty() ? "" : ": ") + error.problem(),
                     error.remedy());
            });
        }
    }

    /// Notes when a run begins, before its first point is computed. A run that is continued keeps its first time.
    static void begin_times(const StudyRun& run, Work& work, ResultFile& file) {
        work.times = file.point_count(run.name) > 0 ? times_of(file, run.name) : std::nullopt;
        if (!work.times)
            work.times = RunTimes{present_time(), "", 0};
        note_times(file, run.name, *work.times);
    }

    /// Reports a failed run, and removes the results of an earlier version of it so that no other run uses them.
    void fail(const StudyRun& run, RunReport& report, ResultFile& file, RunOutcome outcome, const std::string& problem,
              const std::string& remedy) {
        report.outcome = outcome;
        report.problem = problem;
        report.remedy = remedy;
        failed_.insert(run.name);
        const RunRecord record = record_of(run, parent_fingerprint(run, fingerprints_), 0);
        const auto known = fingerprints_.find(run.name); // includes the parameters that other runs have found
        const auto stored = file.find_run(run.name);
        if (!stored || stored->fingerprint != (known == fingerprints_.end() ? record.fingerprint : known->second))
            file.begin_run(record);
        report.points = file.point_count(run.name);
    }

    /// Leaves a run, or the rest of it, to others.
    void leave(const StudyRun& run, RunReport& report) {
        report.outcome = RunOutcome::partial;
        partial_.insert(run.name);
    }

    /// True when the file has the run as it is asked for; otherwise notes that it begins.
    bool is_there_or_begins(const StudyRun& run, std::size_t points, Work& work) {
        return file_.with([&](ResultFile& file) {
            const RunRecord record = record_of(run, parent_fingerprint(run, fingerprints_), points);
            fingerprints_[run.name] = record.fingerprint;
            const bool is_there = is_done(record, file);
            if (!is_there)
                begin_times(run, work, file);
            return is_there;
        });
    }

    /// A copy of a run with the parameters that other runs have found.
    StudyRun with_found(const StudyRun& run) {
        return file_.with([&](const ResultFile& file) { return with_parameters_found(run, file); });
    }

    /// Carries out a run of kind record or identify.
    void do_measured(const StudyRun& wanted, Work& work) {
        const StudyRun run = file_.with([&](const ResultFile& file) { return measured_run(wanted, file); });
        work.report.points = points_of(run);
        const bool done = is_there_or_begins(run, work.report.points, work);
        if (done || is_found_or_left(run, work))
            return;
        const bool complete = run_measured(run, file_, options_.interrupted, [&](bool computed) {
            work.report.computed += computed ? 1 : 0;
            tell(run, work);
            if (!computed)
                --progress_.computed;
        });
        file_.with([&](ResultFile& file) { complete ? file.complete_run(run.name) : file.flush(); });
        work.report.outcome = complete ? RunOutcome::complete : RunOutcome::interrupted;
    }

    /// Takes results from elsewhere. @return false when they have to be computed here
    bool is_found_or_left(const StudyRun& run, Work& work) {
        if (!elsewhere_.results)
            return false;
        const std::string fingerprint = file_.with([&](ResultFile&) { return fingerprints_.at(run.name); });
        const auto found = elsewhere_.results({run, fingerprint, options_.interrupted});
        const auto record = found ? found->find_run(run.name) : std::nullopt;
        if (!record) {
            if (options_.interrupted())
                work.report.outcome = RunOutcome::interrupted;
            else
                file_.with([&](ResultFile&) { leave(run, work.report); });
            return true;
        }
        if (run.is_branch() && options_.orbit)
            for (const OrbitRecord& orbit : found->orbits(run.name, false))
                options_.orbit(run.name, orbit);
        file_.with([&](ResultFile& file) {
            copy_rows(*found, *record, file, run.name);
            work.report.points = work.report.computed = file.point_count(run.name);
            if (record->status == RunStatus::failed && !lacks_orbits(*record, *found))
                throw failure_of(*record);
            file.complete_run(run.name);
            if (run.is_branch())
                note_missing_orbits(run, work.report, file);
        });
        return true;
    }

    void do_branch(const StudyRun& run, Work& work) {
        const bool done = is_there_or_begins(run, 0, work);
        if (!done && is_found_or_left(run, work))
            return;
        const bool complete = done || run_branch(*study_, run, file_, options_, work.report);
        file_.with([&](ResultFile& file) {
            if (done)
                work.report.points = file.point_count(run.name);
            else
                complete ? file.complete_run(run.name) : file.flush();
            work.report.outcome = !complete                     ? RunOutcome::interrupted
                                  : work.report.problem.empty() ? RunOutcome::complete
                                                                : RunOutcome::failed;
            if (complete)
                note_missing_orbits(run, work.report, file);
        });
    }

    /// Marks a run as failed when it, or one of its parts, has found no orbit.
    void note_missing_orbits(const StudyRun& run, RunReport& report, const ResultFile& file) {
        std::size_t found = 0;
        std::string why;
        for (const OrbitRecord& record : file.orbits(run.name, true))
            if (record.point.solution.outcome == OrbitOutcome::converged)
                ++found;
            else if (why.empty())
                why = record.point.detail.empty() ? std::string(name_of(record.point.solution.outcome))
                                                  : record.point.detail;
        if (why.empty())
            return;
        if (found == 0)
            failed_.insert(run.name);
        report.outcome = RunOutcome::failed;
        report.problem = fmt::format("no orbit was found{}: {}", found > 0 ? " for a part of it" : "", why);
        report.remedy = "begin nearer to an orbit, or elsewhere";
    }

    void do_points(const StudyRun& wanted, Work& work) {
        const auto start = file_.with([&](const ResultFile& file) {
            return wanted.start ? std::optional(point_to_start_from(wanted, *study_, file)) : std::nullopt;
        });
        StudyRun run = wanted;
        if (start)
            set_parameters(run.model, start->parameters);
        work.report.points = points_of(run);
        const bool done = is_there_or_begins(run, work.report.points, work);
        if (!done)
            compute_points(run, start ? &start->point : nullptr, work);
    }

    void compute_points(const StudyRun& run, const PointRecord* start, Work& work) {
        const PartedRun parted(run, start);
        std::string fingerprint;
        const auto known = file_.with([&](const ResultFile& file) {
            const auto progress = progress_of(file, parted, work.counted);
            progress_.study_done += work.counted;
            fingerprint = fingerprints_.at(run.name);
            return progress;
        });
        const PointSink keep = [&](std::size_t point, PointResult& result) {
            file_.with([&](ResultFile& file) {
                work.report.returns += result.periods_run;
                file.add_point(run.name, {point, row_of(run, point), direction_of(run, point),
                                          coordinates_of(run, point), std::move(result)});
                ++work.report.computed;
                tell(run, work);
            });
        };
        ExecutionOptions execution;
        execution.jobs = work.threads;
        execution.interrupted = options_.interrupted;
        const bool ended =
            elsewhere_.points
                ? elsewhere_.points({parted, fingerprint, known, work.threads, options_.interrupted}, keep)
                : parted.compute({0, parted.chains()}, known, execution, keep);
        work.report.outcome = ended ? RunOutcome::complete : RunOutcome::interrupted;
        file_.with([&](ResultFile& file) {
            file.flush();
            if (!ended)
                return;
            if (elsewhere_.points && file.point_count(run.name) < work.report.points)
                return leave(run, work.report);
            label_transients(file, run.name);
            file.complete_run(run.name);
        });
    }

    void tell(const StudyRun& run, Work& work) {
        ++work.counted;
        ++progress_.study_done;
        ++progress_.computed;
        if (!options_.progress)
            return;
        progress_.run = run.name;
        progress_.done = work.counted;
        progress_.points = work.report.points;
        options_.progress(progress_);
    }

    const Study* study_;
    std::string path_;
    SharedFile file_;
    Turns turns_;
    RunnerOptions options_;
    Elsewhere elsewhere_;
    std::vector<const StudyRun*> runs_; ///< the runs to be carried out, in the order of the study
    std::set<std::string> failed_, partial_;
    std::map<std::string, std::string> fingerprints_;
    StudyProgress progress_;
    std::vector<std::optional<RunReport>> reports_; ///< of runs that have begun
    std::atomic<bool> stopped_ = false;             ///< no further run may begin
    std::atomic<bool> broken_off_ = false;          ///< an error stops all runs
};

/// Stores the names of points, which may change without computing runs again.
void name_points(const Study& study, ResultFile& file) {
    for (const RunRecord& record : file.runs())
        if (const StudyRun* run = study.find_run(record.name))
            file.name_points(run->name, run->point_names);
}

} // namespace

std::vector<RunReport> run_study(const Study& study, ResultFile& file, const RunnerOptions& options,
                                 const Elsewhere& elsewhere) {
    Runner runner(study, file, options, elsewhere);
    if (study.file != file.path()) // otherwise the study was read from this file
        store_study(study, file);
    name_points(study, file);
    const std::vector<RunReport> reports = runner.run();
    // The order of the study, not that in which runs have begun.
    file.order_runs(names_of(study.runs));
    return reports;
}

std::vector<RunReport> run_study(const Study& study, ResultFile& file, const RunnerOptions& options) {
    return run_study(study, file, options, {});
}

} // namespace graze
