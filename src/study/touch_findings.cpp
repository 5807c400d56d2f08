#include "graze/grazing/verdict.hpp"
#include "study/branch_part.hpp"

#include <string>
#include <vector>

namespace graze {

namespace {

std::optional<OrbitTouch> touch_at(const StudyRun& run, const System& system, const SpecialPoint& point) {
    if (point.type == PointType::grazing)
        return OrbitTouch{point.segment, point.event, point.time, point.at_end};
    if (run.kind != RunKind::curve || point.solution.outcome != OrbitOutcome::converged)
        return std::nullopt;
    const std::vector<OrbitTouch> touches = touches_of(system, point.solution.orbit);
    return touches.empty() ? std::nullopt : std::optional(touches.front());
}

/// On curves first the parameter that was freed, as `graze grazing` has it.
std::vector<ParameterId> moving_parameters(const StudyRun& run) {
    const BranchSettings& settings = run.branch().settings;
    std::vector<ParameterId> result;
    if (run.kind == RunKind::curve && !settings.free.empty())
        result.push_back(settings.free.front());
    result.push_back(settings.parameter);
    return result;
}

} // namespace

std::optional<TouchFindings> findings_at(const StudyRun& run, const SpecialPoint& point) {
    if (point.solution.orbit.cycle) // whose motion does not return to the touch
        return std::nullopt;
    const System system(run.model);
    const auto touch = touch_at(run, system, point);
    if (!touch)
        return std::nullopt;
    CycleMap map;
    for (const ParameterId parameter : moving_parameters(run)) {
        CycleMapOptions options;
        options.parameter = parameter;
        map = cycle_map(system, point.solution.orbit, *touch, options);
        if (map.clearance_rate && *map.clearance_rate != 0)
            break;
    }
    const Verdict verdict = verdict_of(map);
    TouchFindings result;
    result.map = name_of(map.exists() ? map.contact.order : MapOrder::none);
    result.verdict = name_of(verdict.outcome);
    result.reason = verdict.reason;
    result.next_contact = verdict.next_contact;
    if (!verdict.projections.empty())
        result.projection = verdict.projections.front();
    result.growth = verdict.growth;
    result.jump_growth = verdict.jump_growth;
    result.reach = verdict.reach;
    result.clearance_rate = map.clearance_rate;
    result.speed_factor = verdict.speed_factor;
    result.fold_distance = verdict.fold_distance;
    return result;
}

} // namespace graze
