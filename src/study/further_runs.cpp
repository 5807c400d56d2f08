#include "graze/study/further_runs.hpp"

#include "graze/base/input_error.hpp"
#include "graze/study/run_times.hpp"
#include "graze/study/stored_study.hpp"
#include "study/run_record.hpp"
#include "study/run_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

using Names = std::map<std::string, std::string>;

/// Replaces the names of the runs that a run needs. @return whether one has changed
bool rename_needs(StudyRun& run, const Names& names) {
    bool changed = false;
    const auto rename = [&](std::string& name) {
        const auto found = names.find(name);
        if (found == names.end())
            throw InputError(fmt::format("run '{}' goes on from run '{}', which has no results", run.name, name),
                             "run the study again");
        changed = changed || found->second != name;
        name = found->second;
    };
    if (run.start)
        rename(run.start->run);
    std::ranges::for_each(run.parameters, rename);
    if (run.kind == RunKind::identify)
        std::ranges::for_each(run.identify().records, rename);
    return changed;
}

/// The record of a copy, which runs of other names come before.
RunRecord renamed(const RunRecord& record, const StudyRun& run, const ResultFile& to) {
    std::string parents;
    for (const auto& need : run.needs())
        parents += (parents.empty() ? "" : " ") + to.find_run(need.first)->fingerprint;
    const RunRecord asked = record_of(run, parents, record.points);
    RunRecord copy = record;
    copy.settings = asked.settings;
    copy.fingerprint = asked.fingerprint;
    return copy;
}

/// The name of a run that is the same, as far as it was computed; empty: there is none.
std::string same_run(const ResultFile& from, const RunRecord& run, const ResultFile& to,
                     const std::vector<RunRecord>& there) {
    for (const RunRecord& one : there)
        if (one.kind == run.kind && one.fingerprint == run.fingerprint && one.status == run.status &&
            to.point_count(one.name) == from.point_count(run.name))
            return one.name;
    return "";
}

std::string free_name(const std::string& name, const std::vector<RunRecord>& there) {
    std::string result = name;
    for (int number = 2; std::ranges::find(there, result, &RunRecord::name) != there.end(); ++number)
        result = fmt::format("{}_{}", name, number);
    return result;
}

/// Of an unfinished run not all points are there.
std::vector<std::size_t> numbers_of_points(const ResultFile& file, const std::string& run) {
    std::vector<std::size_t> numbers;
    auto rows = file.query(fmt::format("SELECT number FROM \"points_{}\" ORDER BY number", run));
    while (rows.next())
        numbers.push_back(static_cast<std::size_t>(rows.integer(0)));
    return numbers;
}

void copy_results(const ResultFile& from, const RunRecord& run, ResultFile& to, const RunRecord& copy) {
    to.begin_run(copy);
    to.name_points(copy.name, run.point_names);
    if (run.is_branch())
        for (const OrbitRecord& orbit : from.orbits(run.name, false))
            to.add_orbit(copy.name, orbit);
    else
        for (const std::size_t number : numbers_of_points(from, run.name))
            if (const auto point = from.point(run.name, number))
                to.add_point(copy.name, *point);
    if (const EstimateRecords found = from.estimates(run.name); !found.numbers.empty())
        to.set_estimates(copy.name, found);
    to.flush();
    if (run.status == RunStatus::complete)
        to.complete_run(copy.name);
    if (run.status == RunStatus::failed)
        to.fail_run(copy.name, run.failure);
    if (const auto times = times_of(from, run.name))
        note_times(to, copy.name, *times);
}

} // namespace

std::map<std::string, std::string> copy_runs(const ResultFile& from, ResultFile& to,
                                             const std::vector<std::string>& names) {
    const Study study = stored_study(from);
    const std::set<std::string> wanted = wanted_runs(study, names);
    const std::vector<RunRecord> before = to.runs();
    Names copies;
    for (StudyRun run : study.runs) {
        const auto record = wanted.contains(run.name) ? from.find_run(run.name) : std::nullopt;
        if (!record)
            continue;
        const RunRecord same = rename_needs(run, copies) ? renamed(*record, run, to) : *record;
        std::string& name = copies[record->name];
        name = same_run(from, same, to, before);
        if (!name.empty())
            continue;
        RunRecord copy = same;
        copy.name = name = free_name(record->name, to.runs());
        copy_results(from, *record, to, copy);
    }
    return copies;
}

} // namespace graze
