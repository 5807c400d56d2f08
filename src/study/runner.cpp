#include "graze/study/runner.hpp"

#include "graze/model/model_file.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/run_times.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/symbolic/require.hpp"
#include "study/branch_run.hpp"
#include "study/start_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

namespace graze {

namespace {

/// Changes when the same settings lead to other numbers than in an earlier version.
constexpr int numbers = 2;

/// FNV-1a with two seeds: equal for equal texts everywhere, and different for others with near certainty.
std::string hash(const std::string& text) {
    std::string result;
    for (std::uint64_t value : {std::uint64_t{0xcbf29ce484222325u}, std::uint64_t{0x84222325cbf29ce4u}}) {
        for (const char c : text)
            value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
        result += fmt::format("{:016x}", value);
    }
    return result;
}

/// All parameters, the one that is followed first.
void add_parameters(const StudyRun& run, RunRecord& record) {
    const std::vector<std::string> parameters = run.model.independent_parameters();
    const auto add = [&](std::size_t p) {
        const std::string& name = parameters[p];
        record.coordinates.push_back({name, run.model.parameters[*run.model.find_parameter(name)].unit});
    };
    if (!parameters.empty())
        add(run.branch.settings.parameter.place());
    for (std::size_t p = 0; p < parameters.size(); ++p)
        if (p != run.branch.settings.parameter.place())
            add(p);
}

/// Of runs that were not read from a file.
void require_fitting(const StudyRun& run) {
    require_size(run.value_names.size(), run.values.size(), "names of values");
    require_size(run.value_units.size(), run.values.size(), "units of values");
    const std::vector<std::string> parameters = run.model.independent_parameters();
    for (const Variation& axis : run.axes) {
        if (axis.state)
            require_index(*axis.state, run.model.states.size(), "state");
        else
            require_index(axis.parameter.place(), parameters.size(), "independent parameter");
        const std::string& varied =
            axis.state ? run.model.states[*axis.state].name : parameters[axis.parameter.place()];
        if (axis.name != varied)
            throw InputError(fmt::format("the axis '{}' varies '{}'", axis.name, varied),
                             "give it the name of what varies");
    }
}

RunRecord record_of(const StudyRun& run, const std::string& parent_fingerprint, std::size_t points) {
    require_fitting(run);
    RunRecord record;
    record.name = run.name;
    record.kind = name_of(run.kind);
    record.model_name = run.model.name;
    record.model = write_model(run.model);
    record.settings = settings_of(run);
    record.version = GRAZE_VERSION;
    record.fingerprint = hash(fmt::format("{} {} {} {}", numbers, record.model, record.settings, parent_fingerprint));
    if (run.is_branch())
        add_parameters(run, record);
    for (const Variation& axis : run.axes)
        record.coordinates.push_back({axis.name, axis.unit});
    for (const State& state : run.model.states)
        record.states.push_back({state.name, state.unit});
    if (run.is_branch())
        for (const Monitor& monitor : run.branch.settings.monitors)
            record.values.push_back({monitor.name, monitor.unit});
    for (std::size_t v = 0; v < run.values.size() && !run.is_branch(); ++v)
        record.values.push_back({run.value_names[v], run.value_units[v]});
    for (const Sampling& sampling : run.is_branch() ? std::vector<Sampling>() : run.samplings)
        record.samplings.push_back(sampling.name);
    record.modes = names_of(run.model.modes);
    record.directions = direction_names(run);
    record.points = points;
    return record;
}

} // namespace

std::vector<std::string> direction_names(const StudyRun& run) {
    if (run.kind != RunKind::sweep && run.kind != RunKind::follow)
        return {""};
    switch (run.direction) {
    case SweepDirection::up:
        return {"up"};
    case SweepDirection::down:
        return {"down"};
    case SweepDirection::both:
        return {"up", "down"};
    }
    return {};
}

namespace {

std::unique_ptr<SearchFactory> searches_of(const StudyRun& run, const System& system) {
    return run.kind == RunKind::simulate
               ? transient_searches(system, run.transient, run.samplings, run.values, run.simulation)
               : attractor_searches(system, run.attractor, run.samplings, run.values, run.simulation);
}

/// What the file has of each chain.
std::vector<ChainProgress> progress_of(const ResultFile& file, const StudyRun& run, const Plan& plan,
                                       std::size_t& done) {
    std::vector<ChainProgress> progress(plan.chains);
    for (const PointRecord& point : file.last_points(run.name, plan.chain_length)) {
        const std::size_t chain = point.number / plan.chain_length;
        if (chain >= progress.size() || point.result.mode >= run.model.modes.size())
            continue; // none of ours: it is computed anew
        progress[chain] = {point.number % plan.chain_length + 1, can_be_carried_on(point.result), point.result.state,
                           point.result.mode};
        done += progress[chain].done;
    }
    return progress;
}

std::set<std::string> wanted_runs(const Study& study, const std::vector<std::string>& only) {
    for (const std::string& name : only)
        run_named(study, name);            // throws when there is none
    for (const StudyRun& run : study.runs) // of studies that were not read from a file
        if (run.start)
            run_named(study, run.start->run);
    std::set<std::string> wanted(only.begin(), only.end());
    for (auto run = study.runs.rbegin(); run != study.runs.rend(); ++run)
        if (only.empty() || wanted.contains(run->name)) {
            wanted.insert(run->name);
            if (run->start)
                wanted.insert(run->start->run);
        }
    return wanted;
}

/// Equal fingerprints promise that, in a file that nobody has changed.
bool has_columns_of(const RunRecord& stored, const RunRecord& record) {
    const auto same = [](const std::vector<ResultColumn>& a, const std::vector<ResultColumn>& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [](const ResultColumn& one, const ResultColumn& other) { return one.name == other.name; });
    };
    return stored.kind == record.kind && stored.points == record.points && stored.modes == record.modes &&
           stored.samplings == record.samplings && stored.directions == record.directions &&
           same(stored.coordinates, record.coordinates) && same(stored.states, record.states) &&
           same(stored.values, record.values);
}

/// Whether the file has all of a run as it is asked for now. Otherwise what it has is kept only if it can be gone on
/// with.
bool is_done(const RunRecord& record, ResultFile& file) {
    const auto stored = file.find_run(record.name);
    const bool same = stored && stored->fingerprint == record.fingerprint && has_columns_of(*stored, record);
    if (same && stored->status == RunStatus::complete)
        return true;
    if (!same || record.is_branch())
        file.begin_run(record);
    return false;
}

/// A run whose parameters are those of the point that it starts from.
StudyRun at_start(const StudyRun& run, const StartPoint& start) {
    StudyRun result = run;
    set_parameters(result.model, start.parameters);
    return result;
}

/// What does a study's runs, one after the other.
class Runner {
public:
    Runner(const Study& study, ResultFile& file, const RunnerOptions& options)
        : study_(&study), file_(&file), options_(&options), wanted_(wanted_runs(study, options.only)) {
        for (const StudyRun& run : study.runs)
            if (wanted_.contains(run.name))
                all_ += planned_points(run);
    }

    std::vector<RunReport> run() {
        using Clock = std::chrono::steady_clock;
        for (const StudyRun& run : study_->runs) {
            if (!wanted_.contains(run.name))
                continue;
            const auto begun = Clock::now();
            times_.reset();
            reports_.push_back(attempt(run));
            before_ += planned_points(run);
            reports_.back().seconds = std::chrono::duration<double>(Clock::now() - begun).count();
            end_times(reports_.back());
            if (reports_.back().outcome == RunOutcome::interrupted)
                break;
        }
        return std::move(reports_);
    }

private:
    static std::size_t planned_points(const StudyRun& run) { return run.is_branch() ? 1 : points_of(run); }

    /// A run that fails is told of, and those that do not start from it go on.
    RunReport attempt(const StudyRun& run) {
        RunReport report;
        report.name = run.name;
        report.kind = name_of(run.kind);
        if (run.start && failed_.contains(run.start->run)) {
            fail(run, report, RunOutcome::skipped,
                 fmt::format("run '{}', from which it starts, failed", run.start->run), "mend that one first");
            return report;
        }
        try {
            run.is_branch() ? do_branch(run, report) : do_points(run, report);
        } catch (const InputError& error) {
            if (error.place().file == file_->path()) // the file cannot be written: neither can other runs
                throw;
            file_->flush();
            const std::string place = error.place().text();
            fail(run, report, RunOutcome::failed, place + (place.empty() ? "" : ": ") + error.problem(),
                 error.remedy());
        }
        return report;
    }

    /// Before the first point of a run is computed. What is gone on with was begun earlier.
    void begin_times(const std::string& run) {
        times_ = file_->point_count(run) > 0 ? times_of(*file_, run) : std::nullopt;
        if (!times_)
            times_ = RunTimes{present_time(), "", 0};
        note_times(*file_, run, *times_);
    }
    void end_times(const RunReport& report) {
        if (!times_)
            return;
        times_->seconds += report.seconds;
        if (report.outcome != RunOutcome::interrupted)
            times_->ended = present_time();
        note_times(*file_, report.name, *times_);
    }

    /// Nothing of an earlier version of the run is left for others to take for its results.
    void fail(const StudyRun& run, RunReport& report, RunOutcome outcome, const std::string& problem,
              const std::string& remedy) {
        report.outcome = outcome;
        report.problem = problem;
        report.remedy = remedy;
        failed_.insert(run.name);
        const RunRecord record = record_of(run, parent_fingerprint(run), 0);
        const auto stored = file_->find_run(run.name);
        if (!stored || stored->fingerprint != record.fingerprint)
            file_->begin_run(record);
        report.points = file_->point_count(run.name);
    }

    std::string parent_fingerprint(const StudyRun& run) const {
        const auto found = run.start ? fingerprints_.find(run.start->run) : fingerprints_.end();
        return found == fingerprints_.end() ? "" : found->second;
    }

    void do_branch(const StudyRun& run, RunReport& report) {
        const RunRecord record = record_of(run, parent_fingerprint(run), 0);
        fingerprints_[run.name] = record.fingerprint;
        if (is_done(record, *file_)) {
            report.points = file_->point_count(run.name);
        } else {
            begin_times(run.name);
            const bool complete = run_branch(*study_, run, *file_, *options_, report);
            complete ? file_->complete_run(run.name) : file_->flush();
            report.outcome = complete ? RunOutcome::complete : RunOutcome::interrupted;
        }
        if (report.outcome == RunOutcome::complete)
            note_missing_orbits(run, report);
    }

    /// A run that has come to its end without an orbit, or with parts that have none, has failed.
    void note_missing_orbits(const StudyRun& run, RunReport& report) {
        std::size_t found = 0;
        std::string why;
        for (const OrbitRecord& record : file_->orbits(run.name, true))
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

    void do_points(const StudyRun& wanted, RunReport& report) {
        std::optional<StartPoint> start;
        if (wanted.start)
            start = point_to_start_from(wanted, *study_, *file_);
        const StudyRun run = start ? at_start(wanted, *start) : wanted;
        report.points = points_of(run);
        const RunRecord record = record_of(run, parent_fingerprint(run), report.points);
        fingerprints_[run.name] = record.fingerprint;
        if (is_done(record, *file_))
            return;
        begin_times(run.name);
        const System system(run.model);
        const Plan plan = plan_of(run, system, start ? &start->point : nullptr);
        std::size_t done = 0;
        const auto progress = progress_of(*file_, run, plan, done);
        ExecutionOptions execution;
        execution.jobs = options_->jobs;
        execution.interrupted = options_->interrupted;
        const auto searches = searches_of(run, system);
        const bool complete = execute(
            plan, *searches, progress, execution, [&](std::size_t point, const PointStart&, PointResult& result) {
                report.returns += result.periods_run;
                file_->add_point(run.name, {point, point / plan.chain_length, direction_of(run, point),
                                            coordinates_of(run, point), std::move(result)});
                ++report.computed;
                if (options_->progress)
                    options_->progress(run.name, before_ + done + report.computed, all_);
            });
        complete ? file_->complete_run(run.name) : file_->flush();
        report.outcome = complete ? RunOutcome::complete : RunOutcome::interrupted;
    }

    const Study* study_;
    ResultFile* file_;
    const RunnerOptions* options_;
    std::set<std::string> wanted_, failed_;
    std::map<std::string, std::string> fingerprints_;
    std::size_t all_ = 0, before_ = 0; ///< points of the study; of the runs before this one
    std::vector<RunReport> reports_;
    std::optional<RunTimes> times_; ///< of the present run, if it computes something
};

} // namespace

std::vector<RunReport> run_study(const Study& study, ResultFile& file, const RunnerOptions& options) {
    Runner runner(study, file, options);
    if (study.file != file.path()) // otherwise it has been read from there
        store_study(study, file);
    return runner.run();
}

} // namespace graze
