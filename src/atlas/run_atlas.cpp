#include "graze/atlas/run_atlas.hpp"

#include "atlas/exploration.hpp"
#include "graze/study/outdated_runs.hpp"
#include "graze/study/stored_study.hpp"

#include <algorithm>
#include <chrono>
#include <set>

namespace graze {

namespace {

/// Names of the runs of kind atlas.
std::vector<std::string> atlases_of(const Study& study) {
    std::vector<std::string> names;
    for (const StudyRun& run : study.runs)
        if (run.kind == RunKind::atlas)
            names.push_back(run.name);
    return names;
}

/// Atlases whose samples are not there, or no longer those that are asked for.
std::vector<std::string> new_atlases(const Study& study, const ResultFile& file) {
    const std::set<std::string> outdated = outdated_runs(study, file);
    std::vector<std::string> names;
    for (const std::string& atlas : atlases_of(study))
        if (!file.find_run(atlas) || outdated.contains(atlas))
            names.push_back(atlas);
    return names;
}

bool is_made_by_any(const std::string& run, const std::vector<std::string>& atlases) {
    return std::ranges::any_of(atlases, [&](const std::string& atlas) { return is_made_by(run, atlas); });
}

/// Adds the runs of an earlier exploration, which the study as its author wrote it does not have.
void add_earlier_runs(Study& study, const ResultFile& file) {
    const std::vector<std::string> fresh = new_atlases(study, file);
    std::erase_if(study.runs, [&](const StudyRun& run) { return is_made_by_any(run.name, fresh); });
    if (file.runs().empty())
        return;
    std::vector<std::string> known = atlases_of(study);
    std::erase_if(known, [&](const std::string& atlas) { return std::ranges::find(fresh, atlas) != fresh.end(); });
    const Study stored = stored_study(file);
    for (const StudyRun& run : stored.runs)
        if (is_made_by_any(run.name, known) && !study.find_run(run.name)) {
            StudyRun& earlier = study.runs.emplace_back(run); // as it was when it was first asked for
            earlier.place = {};
            if (earlier.start)
                earlier.start->place = {};
        }
}

/// Replaces the reports of runs, or adds them.
void take_over(std::vector<RunReport>& reports, std::vector<RunReport> newer) {
    for (RunReport& one : newer) {
        const auto known = std::ranges::find(reports, one.name, &RunReport::name);
        if (known == reports.end())
            reports.push_back(std::move(one));
        else if (one.computed > 0 || !one.complete())
            *known = std::move(one);
    }
}

bool is_interrupted(const std::vector<RunReport>& reports) {
    return std::ranges::any_of(reports, [](const RunReport& one) { return one.outcome == RunOutcome::interrupted; });
}

/// Explores one atlas until nothing is left to do, or time is up, or it is interrupted.
class Explorer {
public:
    Explorer(Study& study, ResultFile& file, const RunnerOptions& options, const StudyRunner& runner,
             std::vector<RunReport>& reports)
        : study_(&study), file_(&file), options_(&options), runner_(&runner), reports_(&reports) {}

    void explore(const std::string& name) {
        const auto begun = std::chrono::steady_clock::now();
        while (!(options_->interrupted && options_->interrupted())) {
            const StudyRun& atlas = *study_->find_run(name);
            const auto report = std::ranges::find(*reports_, name, &RunReport::name);
            if (report == reports_->end() || !report->complete())
                return;
            Exploration exploration(*study_, atlas, *file_);
            const std::vector<StudyRun> runs = exploration.next();
            file_->set_note(ExploredOrbits::note_of(atlas), exploration.explored().decisions());
            const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begun;
            const double limit = 60 * atlas.motion().atlas.minutes;
            if (runs.empty() || (limit > 0 && passed.count() > limit))
                return;
            RunnerOptions options = *options_;
            options.only.clear();
            for (const StudyRun& run : runs) {
                options.only.push_back(run.name);
                study_->runs.push_back(run);
            }
            std::vector<RunReport> newer = (*runner_)(*study_, *file_, options);
            const bool stopped = is_interrupted(newer);
            take_over(*reports_, std::move(newer));
            if (stopped)
                return;
        }
    }

private:
    Study* study_;
    ResultFile* file_;
    const RunnerOptions* options_;
    const StudyRunner* runner_;
    std::vector<RunReport>* reports_;
};

} // namespace

bool has_atlas(const Study& study) {
    return !atlases_of(study).empty();
}

void forget_outdated_atlases(const Study& study, ResultFile& file) {
    const std::vector<std::string> fresh = new_atlases(study, file);
    for (const RunRecord& run : file.runs())
        if (is_made_by_any(run.name, fresh))
            file.remove_run(run.name);
}

std::vector<std::string> add_atlas_runs(Study& study, const ResultFile& file) {
    add_earlier_runs(study, file);
    std::vector<std::string> next;
    for (const std::string& name : atlases_of(study)) {
        const StudyRun& atlas = *study.find_run(name);
        if (!is_computed(study, atlas, file))
            continue;
        for (const StudyRun& run : Exploration(study, atlas, file).next()) {
            next.push_back(run.name);
            study.runs.push_back(run);
        }
    }
    return next;
}

std::vector<RunReport> run_with_atlases(Study& study, ResultFile& file, const RunnerOptions& options,
                                        const StudyRunner& runner) {
    if (!has_atlas(study))
        return runner(study, file, options);
    forget_outdated_atlases(study, file);
    add_earlier_runs(study, file);
    std::vector<RunReport> reports = runner(study, file, options);
    if (is_interrupted(reports))
        return reports;
    Explorer explorer(study, file, options, runner, reports);
    for (const std::string& name : atlases_of(study))
        explorer.explore(name);
    std::vector<RunReport> ordered;
    for (const StudyRun& run : study.runs)
        if (const auto found = std::ranges::find(reports, run.name, &RunReport::name); found != reports.end())
            ordered.push_back(std::move(*found));
    return ordered;
}

} // namespace graze
