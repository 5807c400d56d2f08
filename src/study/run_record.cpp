#include "study/run_record.hpp"

#include "graze/base/require.hpp"
#include "graze/model/model_file.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/stored_study.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

/// Version of the algorithms: it changes when the same settings lead to other numbers than before.
constexpr int version_of_algorithms = 3;

/// Adds all parameters as coordinates: first the one that is followed, of a curve both.
void add_found_parameters(const StudyRun& run, RunRecord& record) {
    const std::vector<std::string> parameters = run.model.independent_parameters();
    const auto add = [&](std::size_t p) {
        const std::string& name = parameters[p];
        record.coordinates.push_back({name, run.model.parameter_unit(name)});
    };
    std::vector<std::size_t> first;
    const bool family = run.branch().settings.family && run.kind != RunKind::curve;
    if (!parameters.empty() && !family)
        first.push_back(run.branch().settings.parameter.place());
    if (run.kind == RunKind::curve && !run.branch().settings.free.empty())
        first.push_back(run.branch().settings.free.front().place());
    for (const std::size_t p : first)
        add(p);
    for (std::size_t p = 0; p < parameters.size(); ++p)
        if (std::find(first.begin(), first.end(), p) == first.end())
            add(p);
}

/// Checks a run that was made in C++.
void require_fitting(const StudyRun& run) {
    const std::size_t values = run.kind == RunKind::identify ? run.value_names.size() : run.values.size();
    require_size(run.value_names.size(), values, "names of values");
    require_size(run.value_units.size(), values, "units of values");
    if (!run.has_motions())
        return;
    const std::vector<std::string> parameters = run.model.independent_parameters();
    for (const Variation& axis : run.motion().axes) {
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

/// @param equations text of the model without its drawing: results stay those of the run when that changes
std::string fingerprint_from(const std::string& equations, const std::string& settings, const std::string& parent) {
    return fingerprint_of(fmt::format("{} {} {} {}", version_of_algorithms, equations, settings, parent));
}

/// The settings that the numbers of a run depend on.
std::string influential_settings(const StudyRun& run) {
    if (run.kind != RunKind::atlas)
        return settings_of(run);
    StudyRun unlimited = run; // its own points are there before anything is explored
    unlimited.motion().atlas = {};
    return settings_of(unlimited);
}

} // namespace

std::string run_fingerprint(const StudyRun& run, const std::string& parent_fingerprint) {
    require_fitting(run);
    return fingerprint_from(write_equations(run.model), influential_settings(run), parent_fingerprint);
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
    record.fingerprint = fingerprint_from(run.model.drawing ? write_equations(run.model) : record.model,
                                          influential_settings(run), parent_fingerprint);
    if (run.is_branch())
        add_found_parameters(run, record);
    if (run.kind == RunKind::record && !run.record().coordinate.empty())
        record.coordinates.push_back({run.record().coordinate, run.model.parameter_unit(run.record().coordinate)});
    if (run.has_motions())
        for (const Variation& axis : run.motion().axes)
            record.coordinates.push_back({axis.name, axis.unit});
    for (const State& state : run.model.states)
        record.states.push_back({state.name, state.unit});
    if (run.is_branch())
        for (const Monitor& monitor : run.branch().settings.monitors)
            record.values.push_back({monitor.name, monitor.unit});
    for (std::size_t v = 0; v < run.value_names.size() && !run.is_branch(); ++v)
        record.values.push_back({run.value_names[v], run.value_units[v]});
    if (!run.is_branch())
        record.samplings = run.sampling_names();
    record.modes = names_of(run.model.modes);
    record.directions = direction_names(run);
    record.points = points;
    record.point_names = run.point_names;
    return record;
}

std::string parent_fingerprint(const StudyRun& run, const std::map<std::string, std::string>& fingerprints) {
    std::string all;
    for (const auto& need : run.needs())
        if (const auto found = fingerprints.find(need.first); found != fingerprints.end())
            all += (all.empty() ? "" : " ") + found->second;
    return all;
}

WrittenRun written(const StudyRun& run) {
    WrittenRun result{{run.name, std::string(name_of(run.kind)), settings_of(run), GRAZE_VERSION, {}, run.value_units},
                      write_model(run.model)};
    if (run.is_branch()) {
        result.asked.units.clear();
        for (const Monitor& monitor : run.branch().settings.monitors)
            result.asked.units.push_back(monitor.unit);
    }
    return result;
}

std::vector<std::string> direction_names(const StudyRun& run) {
    if (run.kind == RunKind::record)
        return run.record().directions;
    if ((!run.is_swept() && !run.is_followed()) || run.kind == RunKind::ladder || run.kind == RunKind::torus)
        return {""};
    switch (run.is_branch() ? run.branch().direction : run.motion().direction) {
    case SweepDirection::up:
        return {"up"};
    case SweepDirection::down:
        return {"down"};
    case SweepDirection::both:
        return {"up", "down"};
    }
    return {};
}

} // namespace graze
