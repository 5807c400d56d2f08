#include "graze/design/reset.hpp"

#include "design/reset_steps.hpp"
#include "graze/base/input_error.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "graze/results/orbit_motion.hpp"
#include "graze/study/plain_states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Returns the model beyond the trip value, with the orbit that no longer exists as initial state.
Model beyond(const TripPoint& trip, const Orbit& orbit, double overshoot) {
    Orbit moved = orbit;
    moved.parameters[trip.control.place()] += overshoot;
    Model model = model_at(trip.system.model(), moved);
    for (std::size_t i = 0; i < model.states.size(); ++i)
        model.set_initial(model.states[i].name, orbit.starts.front()[i]);
    model.set_initial_mode(model.modes[orbit.signature.front().mode].name);
    return model;
}

/// Whether the motion is lost or changes at a point. At other types, such as events that change their order, orbits of
/// the same kind continue.
bool ends_motion(PointType type) {
    using enum PointType;
    constexpr PointType ends[] = {fold, flip, torus, branch_point, asymmetry, grazing};
    return std::ranges::find(ends, type) != std::end(ends);
}

/// Continues the tripped orbit back until it is no longer stable or admissible.
/// @return false if the branch ended before that
bool follow_back(Reset& reset, const TripPoint& trip, const System& system, const Orbit& orbit,
                 const ResetOptions& options) {
    BranchSettings settings;
    settings.parameter = trip.control;
    settings.direction = options.overshoot < 0 ? 1 : -1;
    const double start = orbit.parameters[trip.control.place()];
    (settings.direction < 0 ? settings.least : settings.greatest) = options.least;
    // Bound it at its start, too, so that a branch that turns round ends.
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

/// Finds the reset value by the orbit on which the tripped motion settles. @return false if there is no orbit that can
/// be continued
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
        reset.reason = "no orbit of the tripped motion was found: " + tripped->detail;
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
    settle.section = usual_section(model);
    settle.cycles = options.cycles;
    settle.chaos_cycles = 0; // a label `chaotic` here only gives a start for further steps
    constexpr std::size_t returns = 24;
    settle.largest_period = returns;
    const System system(model);
    const bool known = reset_by_orbit(reset, trip, system, settle, options);
    // A point beyond the trip value is not a reset: one tripped motion becomes another one.
    const bool too_soon = reset.value && *reset.hysteresis(trip.value()) * options.overshoot < 0;
    if (known && !too_soon)
        return reset;
    if (too_soon) {
        const double where = *reset.value;
        reset = {};
        reset.reason = fmt::format("the tripped orbit becomes another motion at {:.9g}, beyond the trip value", where);
    }
    Reset simulated = reset_by_steps(trip, orbit, system, settle, options);
    // If the motion ended, the first reason stands.
    return simulated.motion.empty() ? reset : simulated;
}

} // namespace graze
