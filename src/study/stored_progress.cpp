#include "study/stored_progress.hpp"

#include <algorithm>
#include <utility>

namespace graze {

namespace {

/// True when a stored run has the columns of the record. Equal fingerprints imply it unless the file was changed.
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

} // namespace

KnownChains progress_of(const ResultFile& file, const PartedRun& parted, std::size_t& done) {
    const StudyRun& run = parted.run();
    const std::size_t length = parted.chain_length();
    KnownChains known;
    if (length == 1) { // nothing is carried on
        const auto next = file.point_numbers(run.name);
        ItemRange neighbours;
        for (auto point = next(); point && *point < parted.chains(); point = next(), ++done) {
            if (*point != neighbours.last) {
                known.end(neighbours);
                neighbours = {*point, *point};
            }
            ++neighbours.last;
        }
        known.end(neighbours);
        return known;
    }
    const auto next = file.last_points(run.name, length);
    while (auto point = next()) {
        const std::size_t chain = point->number / length, there = point->number % length + 1;
        PointResult& last = point->result;
        if (chain >= parted.chains() || last.mode >= run.model.modes.size())
            continue; // the point does not belong to this run: its chain is computed anew
        done += there;
        if (there == length)
            known.end({chain, chain + 1});
        else
            known.begin(chain, {there, can_be_carried_on(last), std::move(last.state), last.mode});
    }
    return known;
}

bool lacks_orbits(const RunRecord& run, const ResultFile& file) {
    if (run.status != RunStatus::failed || !run.is_branch())
        return false;
    const std::vector<OrbitRecord> orbits = file.orbits(run.name, true);
    return std::any_of(orbits.begin(), orbits.end(), [](const OrbitRecord& record) {
        return record.point.solution.outcome != OrbitOutcome::converged;
    });
}

InputError failure_of(const RunRecord& run) {
    const std::size_t remedy = run.failure.rfind("; ");
    return remedy == std::string::npos ? InputError(run.failure, "run the study again")
                                       : InputError(run.failure.substr(0, remedy), run.failure.substr(remedy + 2));
}

bool is_done(const RunRecord& record, ResultFile& file) {
    const auto stored = file.find_run(record.name);
    const bool same = stored && stored->fingerprint == record.fingerprint && has_columns_of(*stored, record);
    if (same && stored->model != record.model) // which differ in their drawing only
        file.replace_model(record.name, record.model);
    if (same && stored->settings != record.settings) // which differ in the limits of an exploration only
        file.replace_settings(record.name, record.settings);
    if (same && (stored->status == RunStatus::complete || lacks_orbits(*stored, file)))
        return true;
    if (!same || record.is_branch())
        file.begin_run(record);
    else if (stored->status == RunStatus::failed)
        file.reopen_run(record.name);
    return false;
}

} // namespace graze
