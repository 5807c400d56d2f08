#include "graze/design/reset.hpp"

#include "design/reset_steps.hpp"
#include "graze/base/input_error.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "graze/results/orbit_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// The section of a clock, if there is one.
std::string section_of(const Model& model) {
    const auto phase = std::find_if(model.sections.begin(), model.sections.end(),
                                    [](const Section& section) { return section.state.has_value(); });
    return phase != model.sections.end() ? phase->name : model.sections.empty() ? "" : model.sections.front().name;
}

/// The model where it has tripped, beginning on the orbit that is no longer there.
Model beyond(const TripPoint& trip, const Orbit& orbit, double overshoot) {
    Orbit moved = orbit;
    moved.parameters[trip.control.place()] += overshoot;
    Model model = model_at(trip.system.model(), moved);
    for (std::size_t i = 0; i < model.states.size(); ++i)
        model.set_initial(model.states[i].name, orbit.starts.front()[i]);
    model.set_initial_mode(model.modes[orbit.signature.front().mode].name);
    return model;
}

/// Where a motion that is followed back is lost, or becomes another one. Elsewhere orbits of the same kind go on, as
/// where events change their order.
bool ends_motion(PointType type) {
    switch (type) {
    case PointType::fold:
    case PointType::flip:
    case PointType::torus:
    case PointType::branch_point:
    case PointType::asymmetry:
    case PointType::grazing:
        return true;
    default:
        return false;
    }
}

/// Follows the tripped orbit back until it is no longer stable, or no longer an orbit of the model.
/// @return false where it could not be followed so far that this is known
bool follow_back(Reset& reset, const TripPoint& trip, const System& system, const Orbit& orbit,
                 const ResetOptions& options) {
    BranchSettings settings;
    settings.parameter = trip.control;
    settings.direction = options.overshoot < 0 ? 1 : -1;
    const double start = orbit.parameters[trip.control.place()];
    (settings.direction < 0 ? settings.least : settings.greatest) = options.least;
    // Not beyond where it began, so that a branch that comes round again has an end.
    const double room = std::abs(start - options.least);
    (settings.direction < 0 ? settings.greatest : settings.least) = start - settings.direction * room;
    settings.orbit.error_estimate = false;
    OrbitBranch branch(system, orbit, settings);
    if (!branch.start()) {
        reset.reason = "the tripped orbit cannot be followed: " + branch.detail();
        return false;
    }
    const auto take = [&](const SpecialPoint& point) {
        reset.value = point.parameter;
        reset.how = name_of(point.type);
        if (kind_of(point.type).may_be_kept)
            reset.point = point;
        return true;
    };
    while (branch.step()) {
        if (options.interrupted && options.interrupted()) {
            reset.reason = "interrupted";
            return true;
        }
        for (const SpecialPoint& point : branch.found())
            if (ends_motion(point.type))
                return take(point);
    }
    for (const SpecialPoint& point : branch.found())
        if (kind_of(point.type).changes)
            return take(point);
    reset.reason = branch.outcome() == BranchOutcome::bound
                       ? fmt::format("the tripped motion is still there at {:.9g}", branch.point().parameter)
                       : fmt::format("the tripped orbit could not be followed below {:.9g}: {}",
                                     branch.point().parameter, branch.detail());
    return branch.outcome() == BranchOutcome::bound;
}

/// By the orbit on which the tripped motion settles. @return false where it has none that can be followed
bool reset_by_orbit(Reset& reset, const TripPoint& trip, const System& system, const AttractorOptions& settle,
                    const ResetOptions& options) {
    std::optional<OrbitSolution> tripped;
    try {
        OrbitOptions numbers;
        numbers.error_estimate = false;
        tripped = find_orbit(system, settle, numbers, {}, [&] { return options.interrupted && options.interrupted(); });
    } catch (const InputError& error) {
        reset.reason = error.problem();
        return false;
    }
    if (!tripped) {
        reset.reason = "interrupted";
        return true;
    }
    if (tripped->outcome != OrbitOutcome::converged) {
        reset.reason = "the tripped motion is no orbit that was found: " + tripped->detail;
        return false;
    }
    reset.motion = to_string(system.model(), tripped->orbit.signature);
    return follow_back(reset, trip, system, tripped->orbit, options);
}

} // namespace

std::optional<double> Reset::hysteresis(double trip_value) const {
    return value ? std::optional(trip_value - *value) : std::nullopt;
}

Reset reset_of(const TripPoint& trip, const Orbit& orbit, const ResetOptions& options) {
    Reset reset;
    const Model model = beyond(trip, orbit, options.overshoot);
    AttractorOptions settle;
    settle.section = section_of(model);
    settle.cycles = options.cycles;
    settle.chaos_cycles = 0; // what is taken for chaotic here only tells where to go on
    constexpr std::size_t returns = 24;
    settle.largest_period = returns;
    const System system(model);
    const bool known = reset_by_orbit(reset, trip, system, settle, options);
    // Beyond the trip value there is nothing to come back to: one tripped motion becomes another one.
    const bool too_soon = reset.value && *reset.hysteresis(trip.value()) * options.overshoot < 0;
    if (known && !too_soon)
        return reset;
    if (too_soon)
        reset = {.value = {},
                 .reason = fmt::format("the tripped orbit becomes another motion at {:.9g}, beyond the trip value",
                                       *reset.value),
                 .how = {},
                 .motion = {},
                 .lost_at = {},
                 .point = {}};
    Reset simulated = reset_by_steps(trip, orbit, system, settle, options);
    // A motion that ends has been told of already.
    return simulated.motion.empty() ? reset : simulated;
}

} // namespace graze
