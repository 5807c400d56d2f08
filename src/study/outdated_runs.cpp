#include "graze/study/outdated_runs.hpp"

#include "graze/results/query_interruption.hpp"
#include "study/measured_run.hpp"
#include "study/run_record.hpp"
#include "study/start_point.hpp"

#include <map>

namespace graze {

namespace {

/// The fingerprint that run_study would give the results of a run.
/// @throws InputError where runs that it needs lack what it takes from them
std::string wanted_fingerprint(const StudyRun& wanted, const Study& study, const ResultFile& file,
                               const std::map<std::string, std::string>& fingerprints) {
    StudyRun run = wanted.is_measured() ? measured_run(wanted, file) : with_parameters_found(wanted, file);
    if (run.start && !run.is_branch())
        set_parameters(run.model, point_to_start_from(run, study, file).parameters);
    return run_fingerprint(run, parent_fingerprint(run, fingerprints));
}

} // namespace

std::set<std::string> outdated_runs(const Study& study, const ResultFile& file) {
    std::map<std::string, std::string> stored; // fingerprints
    std::set<std::string> failed;
    for (const RunRecord& record : file.runs()) {
        stored[record.name] = record.fingerprint;
        if (record.status == RunStatus::failed)
            failed.insert(record.name);
    }
    std::set<std::string> outdated;
    for (const StudyRun& run : study.runs) { // each after those that it needs
        const auto found = stored.find(run.name);
        if (found == stored.end())
            continue;
        bool same = true;
        for (const auto& need : run.needs())
            same = same && stored.contains(need.first) && !outdated.contains(need.first);
        try {
            same = same && wanted_fingerprint(run, study, file, stored) == found->second;
        } catch (const InputError&) { // a run that cannot begin would fail
            if (QueryInterruption::requested())
                throw;
            same = false;
        }
        // A run that could not begin has the fingerprint of what was asked for, without what others would have found.
        if (!same && failed.contains(run.name))
            same = run_fingerprint(run, parent_fingerprint(run, stored)) == found->second;
        if (!same)
            outdated.insert(run.name);
    }
    return outdated;
}

} // namespace graze
