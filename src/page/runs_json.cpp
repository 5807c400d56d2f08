#include "page/runs_json.hpp"

#include "graze/branch/special_point.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/run_summary.hpp"
#include "page/quantity_json.hpp"
#include "picture/picture_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <vector>

namespace graze {

namespace {

/// What runs of each kind are, in the order of RunKind.
constexpr std::array<std::string_view, 12> words_of_kinds{"motions of given duration",
                                                          "attractors as a parameter changes",
                                                          "attractors from many initial states",
                                                          "a periodic orbit",
                                                          "equilibria",
                                                          "a branch of periodic orbits or equilibria",
                                                          "a curve of special points",
                                                          "a sequence of grazings",
                                                          "a branch of tori",
                                                          "measured records",
                                                          "estimates from records",
                                                          "an atlas of attractors and branches"};

std::string_view words_of_kind(const std::string& kind) {
    const auto known = run_kind(kind);
    return known ? words_of_kinds.at(static_cast<std::size_t>(*known)) : std::string_view();
}

nlohmann::json described_json(const StoredRun& run, const std::vector<ResultColumn>& columns) {
    nlohmann::json list = nlohmann::json::array();
    for (const ResultColumn& column : columns)
        list.push_back(quantity_json(column.name, column.unit, words_of(run, column.name)));
    return list;
}

/// What is known of every run, computed or not.
nlohmann::json plain_run_json(const std::string& name, std::string_view kind, const std::string& model) {
    const std::string text(kind);
    const auto known = run_kind(kind);
    nlohmann::json one{{"name", name},
                       {"kind", text},
                       {"kind_words", words_of_kind(text)},
                       {"model", model},
                       {"failure", ""},
                       {"remedy", ""},
                       {"escapes", ""},
                       {"points", 0},
                       {"planned", 0},
                       {"revision", ""},
                       {"is_branch", known && is_branch(*known)},
                       {"is_followed", known && is_followed(*known)},
                       {"seeks_attractors", known && seeks_attractors(*known)}};
    for (const char* list : {"labels", "ends", "directions", "parts", "samplings", "coordinates", "values", "states"})
        one[list] = nlohmann::json::array();
    return one;
}

nlohmann::json missing_run_json(const StudyRun& run) {
    nlohmann::json one = plain_run_json(run.name, name_of(run.kind), run.model.name);
    one["status"] = "missing";
    one["planned"] = points_of(run);
    one["samplings"] = run.sampling_names();
    for (std::size_t v = 0; v < run.value_names.size(); ++v)
        one["values"].push_back(
            quantity_json(run.value_names[v], v < run.value_units.size() ? run.value_units[v] : "", ""));
    for (const State& state : run.model.states)
        one["states"].push_back(quantity_json(state.name, state.unit, first_words(state.text)));
    return one;
}

/// How the parts of a branch ended: which way each went, and what it reached.
nlohmann::json ends_json(const StoredRun& run, const RunSummary& summary) {
    std::map<std::string, std::string> types; // of the last point of each part
    if (!summary.ends.empty())
        for (auto rows = run.rows({.columns = {"part", "type"}}); rows.next();)
            types[rows.text(0)] = rows.text(1);
    nlohmann::json list = nlohmann::json::array();
    for (const auto& [part, detail] : summary.ends) {
        const bool is_direction = part == "up" || part == "down";
        const std::string way = is_direction ? fmt::format("{} in {}", part, followed_parameter(run.record)) : part;
        const auto kind = std::ranges::find(point_kinds(), types[part], &PointKind::short_name);
        const bool plain =
            kind == point_kinds().end() || kind->type == PointType::end || kind->type == PointType::regular;
        list.push_back({way, plain                            ? detail
                             : kind->type == PointType::bound ? "bound " + detail
                                                              : fmt::format("{} ({})", kind->name, detail)});
    }
    return list;
}

/// What the rows of a run say. @throws InputError where its model or its rows cannot be read
void add_results(nlohmann::json& one, const ResultFile& file, const RunRecord& record) {
    const StoredRun run(file, record.name, {});
    one["coordinates"] = described_json(run, record.coordinates);
    one["values"] = described_json(run, record.values);
    one["states"] = described_json(run, record.states);
    one["parts"] = run.parts();
    RunReport report;
    report.name = record.name;
    report.kind = record.kind;
    const RunSummary summary = summary_of(report, file);
    one["labels"] = summary.labels;
    one["ends"] = ends_json(run, summary);
    one["remedy"] = summary.remedy;
    one["escapes"] = summary.escapes;
}

nlohmann::json stored_run_json(const ResultFile& file, const RunRecord& record, RunsMemory* memory) {
    const std::string revision = run_revision(file, record);
    if (memory != nullptr)
        if (nlohmann::json known = memory->find(record.name, revision); !known.is_null())
            return known;
    nlohmann::json one = plain_run_json(record.name, record.kind, record.model_name);
    one["status"] = name_of(record.status);
    one["failure"] = record.failure;
    one["points"] = file.point_count(record.name);
    one["planned"] = record.points;
    one["directions"] = record.directions;
    one["samplings"] = record.samplings;
    one["revision"] = revision;
    try {
        add_results(one, file, record);
    } catch (const InputError& error) { // one run that cannot be read does not hide the others
        one["failure"] = error.what();
        one["coordinates"] = columns_json(record.coordinates);
        one["values"] = columns_json(record.values);
        one["states"] = columns_json(record.states);
        return one;
    }
    if (memory != nullptr)
        memory->keep(record.name, revision, one);
    return one;
}

} // namespace

nlohmann::json RunsMemory::find(const std::string& run, const std::string& revision) const {
    const std::lock_guard lock(mutex_);
    const auto found = runs_.find(run);
    return found != runs_.end() && found->second.first == revision ? found->second.second : nlohmann::json();
}

void RunsMemory::keep(const std::string& run, const std::string& revision, nlohmann::json one) {
    const std::lock_guard lock(mutex_);
    runs_[run] = {revision, std::move(one)};
}

void RunsMemory::keep_only(const std::vector<RunRecord>& runs) {
    const std::lock_guard lock(mutex_);
    std::erase_if(runs_,
                  [&](const auto& one) { return std::ranges::find(runs, one.first, &RunRecord::name) == runs.end(); });
}

nlohmann::json RunsMemory::find_all(const std::string& traces, const std::shared_ptr<const Study>& study) const {
    const std::lock_guard lock(mutex_);
    return traces == traces_ && study == study_ ? all_ : nlohmann::json();
}

void RunsMemory::keep_all(const std::string& traces, const std::shared_ptr<const Study>& study,
                          const nlohmann::json& list) {
    const std::lock_guard lock(mutex_);
    const auto is_read = [&](const nlohmann::json& one) {
        return one["revision"].get_ref<const std::string&>().empty() || runs_.contains(one["name"].get<std::string>());
    };
    all_ = std::ranges::all_of(list, is_read) ? list : nlohmann::json();
    traces_ = traces;
    study_ = study;
}

std::string run_revision(const ResultFile& file, const RunRecord& run) {
    std::string names;
    for (const PointName& one : run.point_names)
        names += one.label + '=' + one.name + ';';
    return fmt::format("{}-{}-{}-{:x}", run.fingerprint, name_of(run.status), file.point_count(run.name),
                       std::hash<std::string>{}(names + run.failure));
}

nlohmann::json missing_runs_json(const Study& study) {
    nlohmann::json list = nlohmann::json::array();
    for (const StudyRun& run : study.runs)
        list.push_back(missing_run_json(run));
    return list;
}

nlohmann::json runs_json(const ResultFile& file, const Study* study, RunsMemory* memory) {
    const std::vector<RunRecord> stored = file.runs();
    if (memory != nullptr)
        memory->keep_only(stored);
    nlohmann::json list = nlohmann::json::array();
    if (study != nullptr)
        for (const StudyRun& run : study->runs) {
            const auto found = std::ranges::find(stored, run.name, &RunRecord::name);
            list.push_back(found == stored.end() ? missing_run_json(run) : stored_run_json(file, *found, memory));
        }
    for (const RunRecord& record : stored)
        if (study == nullptr || study->find_run(record.name) == nullptr)
            list.push_back(stored_run_json(file, record, memory));
    return list;
}

} // namespace graze
