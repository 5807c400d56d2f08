#include "graze/trip/touching_map.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

/// Returns the touch of a grazing, or the touch of the orbit of another point.
OrbitTouch touch_of(const System& system, const SpecialPoint& point, std::string_view orbit) {
    if (point.type == PointType::grazing)
        return {point.segment, point.event, point.time, point.at_end};
    const std::vector<OrbitTouch> touches = touches_of(system, point.solution.orbit);
    if (touches.empty())
        throw InputError(fmt::format("{} touches nothing", orbit),
                         "choose a grazing (GR), or a point of a curve of them");
    return touches.front();
}

} // namespace

TouchingMap touching_map(const System& system, const SpecialPoint& point, const std::vector<ParameterId>& candidates,
                         std::string_view orbit) {
    const OrbitTouch touch = touch_of(system, point, orbit);
    CycleMapOptions options;
    options.next_order = true;
    TouchingMap found{{}, cycle_map(system, point.solution.orbit, touch, options)};
    for (const ParameterId parameter : candidates) {
        found.parameter = options.parameter = parameter;
        found.map = cycle_map(system, point.solution.orbit, touch, options);
        if (found.map.clearance_rate && *found.map.clearance_rate != 0)
            break;
    }
    return found;
}

} // namespace graze
