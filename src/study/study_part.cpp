#include "graze/study/study_part.hpp"

#include "graze/base/input_error.hpp"
#include "graze/study/elsewhere.hpp"
#include "graze/study/outdated_runs.hpp"
#include "graze/study/stored_study.hpp"
#include "study/copied_run.hpp"
#include "study/run_schedule.hpp"
#include "study/stored_progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

namespace graze {

namespace {

constexpr const char* part_key = "part of a study"; ///< of the note that says which part a file holds
constexpr const char* ended = " ended";

/// Of one run, so that a basin of millions of chains does not become as many tasks.
constexpr std::size_t most_tasks_of_run = 65536;

/// The tasks of a run of motions among all tasks of its study.
struct SharedRun {
    std::size_t first = 0; ///< number of its first task
    std::size_t chains = 1, chains_of_task = 1, points_of_chain = 1;

    std::size_t tasks() const { return (chains + chains_of_task - 1) / chains_of_task; }
    bool is_in(const StudyPart& part, std::size_t chain) const {
        return (first + chain / chains_of_task) % part.count + 1 == part.number;
    }
    std::size_t points_in(const StudyPart& part) const {
        std::size_t count = 0;
        for (std::size_t chain = 0; chain < chains; chain += chains_of_task)
            count += is_in(part, chain) ? std::min(chains_of_task, chains - chain) : 0;
        return count * points_of_chain;
    }
};

/// A single motion is a task as a run of another kind is.
bool is_shared(const StudyRun& run) {
    return run.has_motions() && chains_of(run) > 1;
}

std::map<std::string, SharedRun> shared_runs(const Study& study) {
    std::map<std::string, SharedRun> shared;
    std::size_t tasks = 0;
    for (const StudyRun& run : study.runs) {
        SharedRun one{.first = tasks};
        if (run.has_motions()) {
            one.chains = chains_of(run);
            one.points_of_chain = points_of(run) / std::max<std::size_t>(one.chains, 1);
            one.chains_of_task = std::max<std::size_t>((one.chains + most_tasks_of_run - 1) / most_tasks_of_run, 1);
        }
        tasks += one.tasks();
        shared.emplace(run.name, one);
    }
    return shared;
}

/// The runs that results have as they are asked for now.
std::set<std::string> present_runs(const Study& study, const ResultFile* results) {
    std::set<std::string> present;
    if (!results)
        return present;
    const std::set<std::string> outdated = outdated_runs(study, *results);
    for (const RunRecord& run : results->runs())
        if (!outdated.contains(run.name) && (run.status == RunStatus::complete || lacks_orbits(run, *results)))
            present.insert(run.name);
    return present;
}

/// Runs that need, directly or through others, all points of a run that is shared and not there.
std::set<std::string> waiting_runs(const Study& study, const std::set<std::string>& present) {
    std::set<std::string> waiting;
    for (const StudyRun& run : study.runs) // each after those that it needs
        for (const auto& need : run.needs()) {
            const StudyRun* needed = study.find_run(need.first);
            if (needed && !present.contains(run.name) && !present.contains(needed->name) &&
                (is_shared(*needed) || waiting.contains(needed->name)))
                waiting.insert(run.name);
        }
    return waiting;
}

/// Computes the chains of a run that are tasks of a part.
bool compute_chains(const AskedPoints& asked, const SharedRun& shared, const StudyPart& part, const PointSink& sink) {
    KnownChains known = asked.known;
    for (std::size_t chain = 0; chain < shared.chains; chain += shared.chains_of_task)
        if (!shared.is_in(part, chain)) // others compute the task
            known.end({chain, std::min(chain + shared.chains_of_task, shared.chains)});
    ExecutionOptions options;
    options.jobs = asked.jobs;
    options.interrupted = asked.interrupted;
    return asked.run.compute({0, asked.run.chains()}, known, options, sink);
}

std::size_t whole_number(std::string_view text) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

} // namespace

std::string text_of(const StudyPart& part) {
    return fmt::format("{}/{}", part.number, part.count);
}

std::string file_of_part(const StudyPart& part) {
    return fmt::format("{}-of-{}.sqlite", part.number, part.count);
}

StudyPart study_part(const std::string& text) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    const StudyPart part{whole_number(std::string_view(text).substr(0, slash)),
                         whole_number(std::string_view(text).substr(std::min(slash + 1, text.size())))};
    if (part.number < 1 || part.number > part.count)
        throw InputError(fmt::format("'{}' is no part of a study", text),
                         "give its number and how many there are, such as 3/64");
    return part;
}

std::optional<StudyPart> part_in(const ResultFile& file) {
    const auto note = file.note(part_key);
    if (!note)
        return std::nullopt;
    return study_part(note->substr(0, note->find(' ')));
}

bool has_ended(const ResultFile& file) {
    const auto note = file.note(part_key);
    return note && note->ends_with(ended);
}

std::vector<std::string> waiting_runs(const Study& study, const ResultFile* results) {
    const std::set<std::string> waiting = waiting_runs(study, present_runs(study, results));
    return {waiting.begin(), waiting.end()};
}

PartReports run_part(const Study& study, const StudyPart& part, const ResultFile* results, ResultFile& file,
                     const RunnerOptions& options) {
    const std::map<std::string, SharedRun> shared = shared_runs(study);
    const std::set<std::string> present = present_runs(study, results), waiting = waiting_runs(study, present);
    RunnerOptions own = options;
    own.only.clear();
    for (const std::string& run : wanted_runs(study, options.only))
        if (!present.contains(run) && !waiting.contains(run) && shared.at(run).points_in(part) > 0)
            own.only.push_back(run);
    file.set_note(part_key, text_of(part));
    store_study(study, file);
    PartReports reports{{}, {waiting.begin(), waiting.end()}};
    if (!own.only.empty()) { // otherwise all runs would be meant
        for (const std::string& run : wanted_runs(study, own.only))
            if (const auto record = present.contains(run) ? results->find_run(run) : std::nullopt) {
                const auto there = file.find_run(run);
                if (!there || there->fingerprint != record->fingerprint || there->status != record->status)
                    copy_run(*results, *record, file, *record);
            }
        Elsewhere elsewhere;
        elsewhere.points = [&](const AskedPoints& asked, const PointSink& sink) {
            const StudyRun& run = asked.run.run();
            const StudyPart whole; // what a task needs is computed by each part that has such a task
            return compute_chains(asked, shared.at(run.name), is_shared(run) ? part : whole, sink);
        };
        elsewhere.expected = [&](const StudyRun& run) {
            return is_shared(run) ? shared.at(run.name).points_in(part) : points_of(run);
        };
        reports.runs = run_study(study, file, own, elsewhere);
    }
    if (std::ranges::none_of(reports.runs, [](const RunReport& one) { return one.outcome == RunOutcome::interrupted; }))
        file.set_note(part_key, text_of(part) + ended);
    return reports;
}

} // namespace graze
