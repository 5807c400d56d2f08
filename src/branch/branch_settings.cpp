#include "base/enumerator_name.hpp"
#include "branch/point_kind.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/branch/orbit_branch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

std::size_t BranchSettings::fixed_monitors() const {
    return static_cast<std::size_t>(std::ranges::count(monitors, true, &Monitor::fixed));
}

void BranchSettings::validate_orbit(const Model& model) const {
    orbit.validate();
    for (const Monitor& monitor : monitors) {
        if (monitor.held)
            require_finite(*monitor.held, "the value at which a monitor is held");
        require_finite(monitor.crossings, "a value of a monitor that is to be reported");
        if (monitor.least && monitor.greatest && !(*monitor.least < *monitor.greatest))
            throw InputError(fmt::format("the bounds of monitor '{}' leave no room", monitor.name),
                             "give the smaller one first");
        if (monitor.kind != Monitor::Kind::multiplier)
            continue;
        if (monitor.fixed)
            throw InputError(fmt::format("monitor '{}' is a multiplier, which cannot be held", monitor.name),
                             "report values of it, or give bounds at which the branch ends");
        if (monitor.place < 1 || monitor.place >= model.states.size() + 1)
            throw InputError(fmt::format("monitor '{}' is multiplier {}, and the model has {} states", monitor.name,
                                         monitor.place, model.states.size()),
                             "give 1 for the largest, 2 for the next, ...");
    }
}

const std::string& FamilyCoordinate::name() const {
    static const std::string period = "period";
    return conserved.empty() ? period : conserved;
}

std::string coordinate_name(const BranchSettings& settings, const Model& model) {
    if (settings.family && !settings.kept)
        return settings.family->name();
    const std::vector<std::string> names = model.independent_parameters();
    return settings.parameter.place() < names.size() ? names[settings.parameter.place()] : "";
}

namespace {

void require_family(const BranchSettings& settings, const Model& model) {
    if (!settings.family || settings.unfolded > 0)
        return;
    if (!settings.family->conserved.empty())
        monitor_of_conserved(model, settings.family->conserved);
    const auto& [least, greatest] = std::pair(settings.family_least, settings.family_greatest);
    if (least && greatest && !(*least < *greatest))
        throw InputError(fmt::format("the bounds of '{}' leave no room", settings.family->name()),
                         "give the smaller one first");
}

} // namespace

void BranchSettings::validate(const Model& model) const {
    continuation.validate();
    validate_orbit(model);
    require_family(*this, model);
    const bool along_family = family && unfolded == 0 && !kept;
    if (!along_family && parameter.place() >= model.independent_parameters().size())
        throw InputError("the branch's parameter is not one of the model's", "choose an independent parameter");
    if (direction != 1 && direction != -1)
        throw InputError(fmt::format("the direction {} is neither 1 nor -1", direction), "give 1 for up, -1 for down");
    if ((least && std::isnan(*least)) || (greatest && std::isnan(*greatest)))
        throw InputError("a bound of the branch is not a number", "give a number, or none");
    if (least && greatest && !(*least < *greatest))
        throw InputError("the branch's bounds leave no room", "give the smaller one first");
    const std::size_t held = fixed_monitors();
    if (kept && !kind_of(kept->type).may_be_kept)
        throw InputError(fmt::format("points of type {} ({}) cannot be followed as a curve", short_name(kept->type),
                                     name_of(kept->type)),
                         "choose another point, or hold a monitor that says what it is");
    if (kept_too && (*kept_too != PointType::sensitivity || !keeps_touch(*this)))
        throw InputError(fmt::format("the condition of a point of type {} cannot be held besides that of another",
                                     short_name(*kept_too)),
                         "hold a vanishing sensitivity (VS) besides a touch within an arc (GR)");
    // Along families parameters are added that take the place of `free` ones.
    const std::size_t conditions = this->conditions();
    const std::size_t added = unfolded > 0 ? 0 : std::max(model.conserved.size(), family && kept ? std::size_t{1} : 0);
    const bool fits =
        unfolded > 0 ? conditions <= free.size() : conditions >= free.size() && conditions <= free.size() + added;
    if (!fits && kept)
        throw InputError(fmt::format("{} monitors are fixed, a point of type {} is kept, and {} further parameters are "
                                     "free",
                                     held, short_name(kept_too.value_or(kept->type)), free.size()),
                         fmt::format("free {} for the point, and one for each monitor that is fixed",
                                     kept_too ? "two parameters" : "one parameter"));
    if (!fits)
        throw InputError(fmt::format("{} monitors are fixed and {} further parameters are free", held, free.size()),
                         "free one parameter for each monitor that is fixed");
    for (const ParameterId one : free)
        if (one.place() >= model.independent_parameters().size() || (!along_family && one == parameter) ||
            std::count(free.begin(), free.end(), one) > 1)
            throw InputError("a free parameter is not one of the model's, or there twice", "name other ones");
    if (work == 0)
        throw InputError("the points of the branch may take no steps of integration", "allow a million");
    for (const FreeBounds& bounds : free_bounds) {
        if (std::count(free.begin(), free.end(), bounds.parameter) == 0)
            throw InputError("bounds are given of a further parameter that is not free",
                             "name it among those that are, or give the branch's own parameter its bounds");
        if ((bounds.least && std::isnan(*bounds.least)) || (bounds.greatest && std::isnan(*bounds.greatest)))
            throw InputError("a bound of a free parameter is not a number", "give a number, or none");
        if (bounds.least && bounds.greatest && !(*bounds.least < *bounds.greatest))
            throw InputError(fmt::format("the bounds of the free parameter '{}' leave no room",
                                         model.independent_parameters()[bounds.parameter.place()]),
                             "give the smaller one first");
    }
}

bool ends_at_point(BranchOutcome outcome) {
    return outcome == BranchOutcome::bound || outcome == BranchOutcome::stopped ||
           outcome == BranchOutcome::unphysical || outcome == BranchOutcome::returned ||
           outcome == BranchOutcome::shrunk || outcome == BranchOutcome::homoclinic;
}

std::string_view name_of(BranchOutcome outcome) {
    constexpr std::string_view names[] = {"all steps made",
                                          "bound reached",
                                          "stopped",
                                          "unphysical beyond",
                                          "closed",
                                          "returned",
                                          "shrinks to an equilibrium",
                                          "becomes homoclinic",
                                          "no convergence",
                                          "undefined beyond",
                                          "too much work",
                                          "no start"};
    return enumerator_name(names, outcome, "");
}

} // namespace graze
