#include "graze/trip/loss_point.hpp"

#include "graze/base/input_error.hpp"
#include "graze/branch/curve_start.hpp"
#include "graze/trip/predicted_trip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

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

/// True for folds and for points on curves of folds that are not touches.
bool is_fold(const SpecialPoint& point) {
    if (point.type == PointType::fold)
        return true;
    const std::vector<PointType> known = curves_at(point);
    const auto has = [&](PointType type) { return std::ranges::find(known, type) != known.end(); };
    return point.type != PointType::branch_point && has(PointType::fold) && !has(PointType::grazing);
}

LossPoint of_fold(const System& system, const SpecialPoint& special, const std::vector<ParameterId>& candidates) {
    if (candidates.empty())
        throw InputError("no parameter is given that moves the orbit from its fold", "name a parameter that does");
    std::optional<FoldPassage> fold;
    for (const ParameterId one : candidates)
        try {
            fold = fold_passage(system, special, one);
            break;
        } catch (const InputError&) {
            if (one == candidates.back())
                throw;
        }
    if (!fold->attracting)
        throw InputError("neither of the two orbits that meet there is stable: no motion is lost",
                         "choose a fold at which a stable branch ends");
    LossPoint point{
        .system = system, .orbit = special.solution.orbit, .parameter = fold->parameter, .name = {}, .unit = {}};
    point.value = fold->value;
    point.side = fold->side;
    point.cycle = fold->cycle;
    point.fold = std::move(fold);
    return point;
}

LossPoint of_touch(const System& system, const SpecialPoint& special, const std::vector<ParameterId>& candidates,
                   std::string_view orbit) {
    TouchingMap found = touching_map(system, special, candidates, orbit);
    Verdict verdict = verdict_of(found.map);
    const double level = level_of_map(found.map, verdict);
    if (!found.parameter || !found.map.clearance_rate || *found.map.clearance_rate == 0)
        throw InputError("no parameter is given that moves the orbit from its touch", "name a parameter that does");
    LossPoint point{
        .system = system, .orbit = special.solution.orbit, .parameter = *found.parameter, .name = {}, .unit = {}};
    point.value = found.map.contact.touch.parameters[found.parameter->place()];
    point.side = *found.map.clearance_rate < 0 ? 1 : -1;
    point.cycle = found.map.time;
    point.level = level;
    point.map = std::move(found.map);
    point.verdict = std::move(verdict);
    return point;
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

LossPoint loss_point(const System& system, const SpecialPoint& point, const std::vector<ParameterId>& candidates,
                     std::string_view orbit) {
    LossPoint found = is_fold(point) ? of_fold(system, point, candidates) : of_touch(system, point, candidates, orbit);
    const Model& model = system.model();
    found.name = model.independent_parameters()[found.parameter.place()];
    found.unit = model.parameter_unit(found.name);
    return found;
}

std::string unit_of_rate(const LossPoint& point) {
    const std::string &unit = point.unit, &time = point.model().time_unit;
    return unit.empty() && time.empty() ? ""
                                        : fmt::format("{}/{}", unit.empty() ? "1" : unit, time.empty() ? "1" : time);
}

} // namespace graze
