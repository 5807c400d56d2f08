#include "study/measured_run.hpp"

#include "graze/base/name_list.hpp"
#include "study/estimate_kind.hpp"
#include "study/identify_run.hpp"
#include "study/identify_units.hpp"
#include "study/record_run.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

std::vector<EstimateRecords> estimates_for(const StudyRun& run, const ResultFile& file) {
    std::vector<EstimateRecords> found;
    for (const std::string& name : run.parameters)
        convert_to_model(found.emplace_back(file.estimates(name)), run); // the other run's model may have other units
    return found;
}

bool run_records(const StudyRun& run, SharedFile& file, const std::function<bool()>& interrupted,
                 const std::function<void(bool)>& told) {
    const std::size_t there = file.with([&](const ResultFile& results) { return results.point_count(run.name); });
    RecordRun records(run);
    for (std::size_t number = 0; number < run.record().records(); ++number) {
        if (number < there) {
            file.with([&](ResultFile&) { told(false); });
            continue;
        }
        if (interrupted && interrupted())
            return false;
        const auto point = records.point(number, interrupted);
        if (!point)
            return false;
        file.with([&](ResultFile& results) {
            results.add_point(run.name, *point);
            told(true);
        });
    }
    return true;
}

bool run_identify(const StudyRun& run, SharedFile& file, const std::function<bool()>& interrupted,
                  const std::function<void(bool)>& told) {
    const auto [records, found] = file.with(
        [&](const ResultFile& results) { return std::pair(kept_records(run, results), estimates_for(run, results)); });
    auto result = identify(run, records, found, interrupted);
    if (!result)
        return false;
    PointResult& point = result->point.result;
    point.label = result->problem.empty() ? Label::ended : Label::failed;
    point.outcome.ending = Ending::end_time;
    point.outcome.detail = result->problem;
    point.state = run.model.initial_state();
    point.mode = run.model.initial_mode;
    file.with([&](ResultFile& results) {
        results.set_estimates(run.name, result->estimates);
        if (results.point_count(run.name) == 0)
            results.add_point(run.name, result->point);
        told(true);
    });
    if (!result->problem.empty())
        throw InputError(run.place,
                         fmt::format("what run '{}' found must not be gone on with: {}", run.name, result->problem),
                         "look at its residuals, and at the records");
    return true;
}

} // namespace

StudyRun with_parameters_found(const StudyRun& run, const ResultFile& file) {
    StudyRun result = run;
    for (const std::string& name : run.parameters) {
        EstimateRecords found = file.estimates(name);
        convert_to_model(found, run);
        std::vector<std::string> names;
        std::size_t taken = 0;
        for (const EstimateRecord& number : found.numbers) {
            names.push_back(number.name);
            const auto parameter = result.model.find_independent_parameter(number.name);
            if (!parameter)
                continue;
            result.model.set_parameter(number.name, number.estimate.value);
            auto& set = result.set;
            if (std::find(set.begin(), set.end(), *parameter) == set.end())
                set.push_back(*parameter);
            ++taken;
        }
        if (taken == 0)
            throw InputError(run.parameters_place,
                             fmt::format("run '{}' has found no parameter of model '{}'", name, run.model.name),
                             fmt::format("it has found {}: give it gives = {{ NAME = \"PARAMETER\" }}",
                                         names.empty() ? "nothing" : name_list(names)));
    }
    return result;
}

StudyRun measured_run(const StudyRun& run, const ResultFile& file) {
    StudyRun result = with_parameters_found(run, file);
    if (run.kind != RunKind::identify)
        return result;
    const auto from = run.identify().records.empty() ? std::nullopt : file.find_run(run.identify().records.front());
    if (!from)
        return result;
    const Model model = stored_model(*from);
    const auto unit = [&](const std::string& name) {
        for (const ResultColumn& value : from->values)
            if (value.name == name)
                return value.unit;
        return std::string();
    };
    const bool of_speeds = estimate_kind(run.identify().what).shows_channel;
    for (std::size_t v = 1; v < result.value_names.size(); ++v)
        result.value_units[v] = result.value_names[v] == "t" ? model.time_unit
                                : of_speeds                  ? unit(run.identify().channel)
                                                             : unit(result.value_names[v]);
    return result;
}

bool run_measured(const StudyRun& run, SharedFile& file, const std::function<bool()>& interrupted,
                  const std::function<void(bool computed)>& told) {
    return run.kind == RunKind::record ? run_records(run, file, interrupted, told)
                                       : run_identify(run, file, interrupted, told);
}

} // namespace graze
