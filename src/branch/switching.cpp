#include "graze/branch/switching.hpp"

#include "branch/equilibrium_switch.hpp"
#include "branch/family.hpp"
#include "branch/point_kind.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace graze {

std::vector<BranchStart> branches_at(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    const Model& model = system.model();
    settings.validate(model);
    if (const auto family = Family::of(system, point.solution.orbit, settings)) {
        std::vector<BranchStart> starts = branches_at(family->system(), family->unfolded(point), family->settings());
        for (BranchStart& start : starts)
            start.orbit = family->folded(std::move(start.orbit));
        return starts;
    }
    const PointRule& rule = rule_of(point.type);
    if (!rule.leave) {
        std::vector<std::string_view> left;
        for (const PointRule& one : point_rules())
            if (one.leave)
                left.push_back(one.kind.short_name);
        throw InputError(
            fmt::format("no other branch leaves from a point of type {} ({})", rule.kind.short_name, rule.kind.name),
            fmt::format("choose one of type {}, or vary another parameter from it", fmt::join(left, ", ")));
    }
    if (rule.kind.limits) {
        require_index(point.segment, point.solution.orbit.segments(), "segment");
        require_index(point.event, model.events.size(), "event");
        require_finite(point.time, "the time of the point");
    }
    validate_orbit(model, point.solution.orbit);
    if (point.solution.orbit.cycle)
        throw InputError("no other branch is followed from an orbit that is homoclinic to a cycle",
                         "follow the orbit itself: onto = \"same\"");
    if (point.type == PointType::branch_point && is_rest(point.solution.orbit.signature))
        return equilibria_at_branch_point(system, point, settings);
    return rule.leave(system, point, settings);
}

} // namespace graze
