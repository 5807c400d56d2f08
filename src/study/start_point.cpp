#include "study/start_point.hpp"

#include "base/read_whole.hpp"
#include "graze/base/input_error.hpp"
#include "study/run_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// All parameters of a point of a run of motions: those of the run, with the values that vary.
std::vector<double> parameters_of(const RunRecord& run, const PointRecord& point) {
    Model model = stored_model(run);
    for (std::size_t c = 0; c < run.coordinates.size(); ++c)
        if (!model.find_state(run.coordinates[c].name))
            model.set_parameter(run.coordinates[c].name, point.coordinates[c]);
    return model.parameter_values();
}

/// The number that names a point; none where the name is no number.
std::optional<std::size_t> number_in(const std::string& name) {
    std::size_t number = 0;
    return read_whole(name, number) ? std::optional(number) : std::nullopt;
}

} // namespace

const StudyRun& run_named(const Study& study, const std::string& name) {
    const StudyRun* const found = study.find_run(name);
    if (!found)
        throw InputError(fmt::format("the study has no run '{}'", name), "name one of its runs");
    return *found;
}

std::vector<double> with_own_parameters(const StudyRun& run, std::vector<double> parameters) {
    const std::vector<double> values = run.model.parameter_values();
    for (const ParameterId parameter : run.set)
        parameters[parameter.place()] = values[parameter.place()];
    return parameters;
}

void set_parameters(Model& model, const std::vector<double>& values) {
    const std::vector<std::string> names = model.independent_parameters();
    for (std::size_t i = 0; i < names.size(); ++i)
        model.set_parameter(names[i], values[i]);
}

namespace {

/// Returns the orbit of a run at which a value is nearest to that asked for.
template <class Value>
std::optional<OrbitRecord> nearest_orbit(const StartFrom& start, const ResultFile& file, const Value& value) {
    std::optional<OrbitRecord> record;
    double least = std::numeric_limits<double>::infinity();
    for (OrbitRecord& one : file.orbits(start.run, false)) {
        const double distance = std::abs(value(one) - start.value);
        if ((start.direction && one.part != *start.direction) || !(distance < least))
            continue;
        least = distance;
        record = std::move(one);
    }
    if (record)
        record->point.type = PointType::regular;
    return record;
}

/// Returns the orbit of a family at which its coordinate is nearest to a value.
std::optional<OrbitRecord> nearest_in_family(const StartFrom& start, const StudyRun& parent, const ResultFile& file) {
    const std::vector<Monitor>& monitors = parent.branch().settings.monitors;
    const auto monitor = std::ranges::find(monitors, *start.coordinate, &Monitor::name);
    const auto place = static_cast<std::size_t>(monitor - monitors.begin());
    return nearest_orbit(start, file, [&](const OrbitRecord& one) {
        return *start.coordinate == "period"       ? one.point.solution.orbit.period()
               : place < one.point.monitors.size() ? one.point.monitors[place]
                                                   : std::numeric_limits<double>::quiet_NaN();
    });
}

} // namespace

OrbitRecord orbit_to_start_from(const StartFrom& start, const StudyRun& parent, const ResultFile& file) {
    std::optional<OrbitRecord> record;
    const auto& family = parent.branch().settings.family;
    if (start.coordinate && family && *start.coordinate == family->name()) {
        record = nearest_in_family(start, parent, file);
    } else if (start.coordinate) {
        const auto found = parent.model.find_independent_parameter(*start.coordinate);
        if (!found)
            throw InputError(start.place, fmt::format("run '{}' has no parameter '{}'", start.run, *start.coordinate),
                             "name one of the model's");
        const std::size_t place = found->place();
        record = nearest_orbit(start, file,
                               [&](const OrbitRecord& one) { return one.point.solution.orbit.parameters[place]; });
        if (record) // the orbit is a first guess at exactly the value that is asked for
            record->point.solution.orbit.parameters[place] = start.value;
    } else if (start.point.empty()) {
        if (parent.is_followed())
            throw InputError(start.place, fmt::format("run '{}' has many points", start.run),
                             "name one: point = \"GR1\", or at = { PARAMETER = VALUE }");
        record = file.orbit(start.run, std::size_t{0});
    } else {
        const auto named = std::ranges::find(parent.point_names, start.point, &PointName::name);
        const std::string& label = named != parent.point_names.end() ? named->label : start.point;
        const auto number = number_in(label);
        record = number ? file.orbit(start.run, *number) : file.orbit(start.run, label);
    }
    if (!record) {
        std::string known;
        for (const OrbitRecord& one : file.orbits(start.run, true))
            known += (known.empty() ? "" : ", ") + one.label;
        throw InputError(start.place, fmt::format("run '{}' has no point '{}'", start.run, start.point),
                         known.empty() ? "it has none at all" : "it has " + known);
    }
    if (record->point.solution.outcome != OrbitOutcome::converged)
        throw InputError(start.place, fmt::format("run '{}' found no orbit there", start.run), "choose another point");
    return *record;
}

StartPoint point_to_start_from(const StudyRun& run, const Study& study, const ResultFile& file) {
    const StartFrom& start = *run.start;
    const StudyRun& parent = run_named(study, start.run);
    if (parent.is_branch()) {
        const Orbit orbit = orbit_to_start_from(start, parent, file).point.solution.orbit;
        StartPoint result;
        result.point.result.state = orbit.starts.front();
        result.point.result.mode = orbit.signature.front().mode;
        result.point.result.label = Label::periodic;
        result.parameters = with_own_parameters(run, orbit.parameters);
        return result;
    }
    std::optional<std::size_t> direction;
    if (start.direction) {
        const auto names = direction_names(parent);
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
    } else if (!start.point.empty()) {
        if (const auto number = number_in(start.point))
            point = file.point(start.run, *number);
        if (!point)
            throw InputError(start.place, fmt::format("run '{}' has no point {}", start.run, start.point),
                             fmt::format("it has {}", file.point_count(start.run)));
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
    return {*point, with_own_parameters(run, parameters_of(*file.find_run(start.run), *point))};
}

} // namespace graze
