#include "program/touching_orbit.hpp"

#include "graze/base/input_error.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace graze {

std::vector<ParameterId> moving_parameters(const StoredRun& run, const std::string& asked) {
    if (!asked.empty())
        return {asked_parameter(run.model, asked)};
    std::vector<ParameterId> result;
    if (run.record.kind == "curve" && run.record.coordinates.size() > 1)
        result.push_back(run.model.independent_parameter(run.record.coordinates[1].name));
    if (const std::string followed = followed_parameter(run.record); !followed.empty())
        result.push_back(run.model.independent_parameter(followed));
    return result;
}

namespace {

/// A grazing is kept with its place; others are looked through for one.
OrbitTouch touch_of(const System& system, const OrbitRecord& record) {
    const SpecialPoint& point = record.point;
    if (point.type == PointType::grazing)
        return {point.segment, point.event, point.time, point.at_end};
    const std::vector<OrbitTouch> touches = touches_of(system, point.solution.orbit);
    if (touches.empty())
        throw InputError(Place{"POINT", 0, 0}, fmt::format("the orbit at {} touches nothing", title_of(record)),
                         "choose a grazing (GR), or a point of a curve of them");
    return touches.front();
}

/// The map with the first of the parameters that moves the orbit; if none does, with the last.
void find_map(TouchingOrbit& found, const System& system, const std::string& asked) {
    const OrbitTouch touch = touch_of(system, found.stored.record);
    CycleMapOptions options;
    options.next_order = true;
    found.map = cycle_map(system, found.stored.record.point.solution.orbit, touch, options);
    for (const ParameterId parameter : moving_parameters(found.stored.run, asked)) {
        found.parameter = options.parameter = parameter;
        found.map = cycle_map(system, found.stored.record.point.solution.orbit, touch, options);
        if (found.map.clearance_rate && *found.map.clearance_rate != 0)
            return;
    }
}

} // namespace

TouchingOrbit find_touching_orbit(const ResultFile& file, const std::string& point, const std::string& parameter) {
    return touching_orbit(find_stored_orbit(file, point, {"POINT", 0, 0}), parameter);
}

TouchingOrbit touching_orbit(StoredOrbit stored, const std::string& parameter) {
    TouchingOrbit found{std::move(stored), {}, {}};
    find_map(found, System(found.stored.run.model), parameter);
    return found;
}

} // namespace graze
