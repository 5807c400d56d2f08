#include "graze/study/further_runs.hpp"

#include "base/letter_case.hpp"
#include "graze/base/input_error.hpp"
#include "graze/study/stored_study.hpp"
#include "results/schema.hpp"
#include "study/copied_run.hpp"
#include "study/run_record.hpp"
#include "study/run_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace graze {

namespace {

using RunNames = std::map<std::string, std::string>;

/// Replaces the names of the runs that a run needs. @return whether one has changed
bool rename_needs(StudyRun& run, const RunNames& names) {
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
RunRecord renamed(const RunRecord& record, const StudyRun& run, const RunNames& fingerprints) {
    const RunRecord asked = record_of(run, parent_fingerprint(run, fingerprints), record.points);
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

} // namespace

std::map<std::string, std::string> copy_runs(const ResultFile& from, ResultFile& to,
                                             const std::vector<std::string>& names) {
    const Study study = stored_study(from);
    const std::set<std::string> wanted = wanted_runs(study, names);
    const std::vector<RunRecord> before = to.runs();
    RunNames copies, fingerprints; // fingerprints by the names there
    std::set<std::string> taken;
    for (const RunRecord& one : before) {
        fingerprints[one.name] = one.fingerprint;
        taken.insert(in_small_letters(one.name));
    }
    for (StudyRun run : study.runs) {
        const auto record = wanted.contains(run.name) ? from.find_run(run.name) : std::nullopt;
        if (!record)
            continue;
        const RunRecord same = rename_needs(run, copies) ? renamed(*record, run, fingerprints) : *record;
        std::string& name = copies[record->name];
        name = same_run(from, same, to, before);
        if (!name.empty())
            continue;
        RunRecord copy = same;
        copy.name = name = distinct_name(record->name, taken);
        fingerprints[name] = copy.fingerprint;
        copy_run(from, *record, to, copy);
    }
    return copies;
}

} // namespace graze
