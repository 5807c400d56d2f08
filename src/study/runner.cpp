#include "graze/study/runner.hpp"

#include "graze/model/model_file.hpp"
#include "study/branch_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

namespace graze {

namespace {

/// Changes when the same settings lead to other numbers than in an earlier version.
constexpr int numbers = 1;

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
    const auto symbols = run.model.parameter_symbols();
    const auto add = [&](std::size_t p) {
        const std::string& name = symbols[p].name();
        record.coordinates.push_back({name, run.model.parameters[*run.model.find_parameter(name)].unit});
    };
    if (!symbols.empty())
        add(run.branch.settings.parameter);
    for (std::size_t p = 0; p < symbols.size(); ++p)
        if (p != run.branch.settings.parameter)
            add(p);
}

RunRecord record_of(const StudyRun& run, const std::string& parent_fingerprint, std::size_t points) {
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
    for (const Mode& mode : run.model.modes)
        record.modes.push_back(mode.name);
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

PointRecord point_to_start_from(const StudyRun& run, const Study& study, const ResultFile& file) {
    const StartFrom& start = *run.start;
    const auto parent = std::find_if(study.runs.begin(), study.runs.end(),
                                     [&](const StudyRun& other) { return other.name == start.run; });
    if (parent->is_branch()) {
        const Orbit orbit = orbit_to_start_from(start, *parent, file).point.solution.orbit;
        PointRecord point;
        point.result.state = orbit.starts.front();
        point.result.mode = orbit.signature.front().mode;
        point.result.label = Label::periodic;
        return point;
    }
    std::optional<std::size_t> direction;
    if (start.direction) {
        const auto names = direction_names(*parent);
        direction = static_cast<std::size_t>(std::find(names.begin(), names.end(), *start.direction) - names.begin());
        if (*direction == names.size())
            throw InputError(start.place, fmt::format("run '{}' has no direction '{}'", start.run, *start.direction),
                             "leave the direction out, or sweep both ways");
    }
    std::optional<PointRecord> point;
    if (start.coordinate) {
        point = file.nearest_point(start.run, *start.coordinate, start.value, direction);
        if (!point)
            throw InputError(start.place, fmt::format("run '{}' has no coordinate '{}'", start.run, *start.coordinate),
                             "name one of those that it varies");
    } else {
        const std::size_t count = file.point_count(start.run);
        if (count > 0)
            point = file.point(start.run, count - 1);
    }
    if (!point)
        throw InputError(start.place, fmt::format("run '{}' has no points to start from", start.run),
                         "let it have some");
    const bool finite =
        std::all_of(point->result.state.begin(), point->result.state.end(), [](double x) { return std::isfinite(x); });
    if (!finite || point->result.state.size() != run.model.states.size() ||
        point->result.mode >= run.model.modes.size() || point->result.label == Label::singular ||
        point->result.label == Label::failed)
        throw InputError(start.place,
                         fmt::format("run '{}' ended there as '{}', with no state to start from", start.run,
                                     name_of(point->result.label)),
                         "choose another point");
    return *point;
}

namespace {

std::unique_ptr<SearchFactory> searches_of(const StudyRun& run) {
    return run.kind == RunKind::simulate
               ? transient_searches(run.model, run.transient, run.samplings, run.values, run.simulation)
               : attractor_searches(run.model, run.attractor, run.samplings, run.values, run.simulation);
}

/// What the file has of each chain.
std::vector<ChainProgress> progress_of(const ResultFile& file, const std::string& run, const Plan& plan,
                                       std::size_t& done) {
    std::vector<ChainProgress> progress(plan.chains);
    for (const PointRecord& point : file.last_points(run, plan.chain_length)) {
        const std::size_t chain = point.number / plan.chain_length;
        progress[chain] = {point.number % plan.chain_length + 1, can_be_carried_on(point.result), point.result.state,
                           point.result.mode};
        done += progress[chain].done;
    }
    return progress;
}

std::set<std::string> wanted_runs(const Study& study, const std::vector<std::string>& only) {
    std::set<std::string> wanted(only.begin(), only.end());
    for (auto run = study.runs.rbegin(); run != study.runs.rend(); ++run)
        if (only.empty() || wanted.contains(run->name)) {
            wanted.insert(run->name);
            if (run->start)
                wanted.insert(run->start->run);
        }
    return wanted;
}

using Fingerprints = std::map<std::string, std::string>;

/// How far a study is before a run, and what there is in all.
struct RunProgress {
    std::size_t before, all;
};

/// Whether the file has all of a run as it is asked for now. Otherwise what it has is kept only if it can be gone on
/// with.
bool is_done(const RunRecord& record, ResultFile& file) {
    const auto stored = file.find_run(record.name);
    const bool same = stored && stored->fingerprint == record.fingerprint;
    if (same && stored->status == RunStatus::complete)
        return true;
    if (!same || record.is_branch())
        file.begin_run(record);
    return false;
}

RunReport do_branch(const Study& study, const StudyRun& run, ResultFile& file, const RunnerOptions& options,
                    Fingerprints& fingerprints) {
    const RunRecord record = record_of(run, run.start ? fingerprints[run.start->run] : "", 0);
    fingerprints[run.name] = record.fingerprint;
    RunReport report{run.name, record.kind, 0, 0, 0, 0, true};
    if (is_done(record, file)) {
        report.points = file.point_count(run.name);
        return report;
    }
    report.complete = run_branch(study, run, file, options, report);
    report.complete ? file.complete_run(run.name) : file.flush();
    return report;
}

RunReport do_points(const Study& study, const StudyRun& run, ResultFile& file, const RunnerOptions& options,
                    Fingerprints& fingerprints, const RunProgress& so_far) {
    std::optional<PointRecord> start;
    if (run.start)
        start = point_to_start_from(run, study, file);
    const Plan plan = plan_of(run, start ? &*start : nullptr);
    const RunRecord record = record_of(run, run.start ? fingerprints[run.start->run] : "", plan.points());
    fingerprints[run.name] = record.fingerprint;
    RunReport report{run.name, record.kind, plan.points(), 0, 0, 0, true};
    if (is_done(record, file))
        return report;
    std::size_t done = 0;
    const auto progress = progress_of(file, run.name, plan, done);
    ExecutionOptions execution;
    execution.jobs = options.jobs;
    execution.interrupted = options.interrupted;
    const auto searches = searches_of(run);
    report.complete =
        execute(plan, *searches, progress, execution, [&](std::size_t point, const PointStart&, PointResult& result) {
            report.returns += result.periods_run;
            file.add_point(run.name, {point, point / plan.chain_length, direction_of(run, point),
                                      coordinates_of(run, point), std::move(result)});
            ++report.computed;
            if (options.progress)
                options.progress(run.name, so_far.before + done + report.computed, so_far.all);
        });
    report.complete ? file.complete_run(run.name) : file.flush();
    return report;
}

} // namespace

std::vector<RunReport> run_study(const Study& study, ResultFile& file, const RunnerOptions& options) {
    using Clock = std::chrono::steady_clock;
    std::vector<RunReport> reports;
    Fingerprints fingerprints;
    const std::set<std::string> wanted = wanted_runs(study, options.only);
    std::size_t all = 0, before = 0;
    for (const StudyRun& run : study.runs)
        if (wanted.contains(run.name))
            all += run.is_branch() ? 1 : plan_of(run, nullptr).points();
    for (const StudyRun& run : study.runs) {
        if (!wanted.contains(run.name))
            continue;
        const auto begun = Clock::now();
        std::size_t planned = 1;
        if (run.is_branch()) {
            reports.push_back(do_branch(study, run, file, options, fingerprints));
        } else {
            const RunProgress progress{before, all};
            reports.push_back(do_points(study, run, file, options, fingerprints, progress));
            planned = reports.back().points;
        }
        before += planned;
        reports.back().seconds = std::chrono::duration<double>(Clock::now() - begun).count();
        if (!reports.back().complete)
            break;
    }
    return reports;
}

} // namespace graze
