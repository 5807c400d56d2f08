#include "branch/family.hpp"

#include "base/concatenated.hpp"
#include "branch/neutral_direction.hpp"
#include "graze/base/input_error.hpp"
#include "graze/model/conserved.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/unused_symbol.hpp"
#include "orbit/certify.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/newton.hpp"
#include "orbit/orbit_flow.hpp"
#include "orbit/segment_arcs.hpp"
#include "orbit/shooting.hpp"

#include <Eigen/Core>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

/// For each mode and state, what the unfolding parameter multiplies in the rate; empty expressions: nothing.
using Unfolding = std::vector<std::vector<Expression>>;

/// True when a state changes somewhere. Those that never do must stay constant, since they are held at their values.
bool may_change(Model& model, std::size_t state) {
    const auto moves = [&](const Mode& mode) { return !model.expand(mode.rates[state]).is_number(0); };
    const auto jumps = [&](const Jump& jump) {
        return std::ranges::any_of(jump.map.changes(), [&](const auto& one) { return one.state == state; });
    };
    return std::ranges::any_of(model.modes, moves) || std::ranges::any_of(model.jumps, jumps);
}

/// Returns the gradient of a conserved quantity along the states that change.
Unfolding by_gradient(Model& model, const ConservedQuantity& conserved) {
    const std::vector<Expression> states = model.state_symbols();
    Unfolding result;
    for (std::size_t mode = 0; mode < model.modes.size(); ++mode) {
        std::vector<Expression>& own = result.emplace_back(states.size());
        const Expression* value = conserved_in(conserved, model.modes[mode].name);
        if (!value)
            continue;
        const Expression expanded = model.expand(*value);
        const std::vector<Expression> gradient = jacobian({&expanded, 1}, states);
        for (std::size_t i = 0; i < states.size(); ++i)
            if (!gradient[i].is_number(0) && may_change(model, i))
                own[i] = gradient[i];
    }
    return result;
}

/// Returns the distance of the states that change from their means along an orbit.
Unfolding by_distance(Model& model, const System& system, const Orbit& orbit, double tolerance) {
    std::vector<Monitor> means;
    for (const State& state : model.states) {
        Monitor& mean = means.emplace_back();
        mean.name = state.name;
        mean.kind = Monitor::Kind::mean;
        mean.expression = model.symbol(state.name);
    }
    const std::vector<double> centre = OrbitMonitors(system, orbit.signature, means, tolerance)(orbit);
    Unfolding result;
    for (std::size_t mode = 0; mode < model.modes.size(); ++mode) {
        std::vector<Expression>& own = result.emplace_back(model.states.size());
        for (std::size_t i = 0; i < model.states.size(); ++i)
            if (const State& state = model.states[i]; !state.period && !state.drifting && may_change(model, i))
                own[i] = model.symbol(state.name) - model.number(centre[i]);
    }
    return result;
}

/// Returns an unfolding at the starts of an orbit's segments, as a vector.
Eigen::VectorXd values_at(const Model& model, const Unfolding& unfolding, const Orbit& orbit) {
    Eigen::VectorXd result(index(orbit.segments() * model.states.size()));
    for (std::size_t s = 0; s < orbit.segments(); ++s) {
        std::vector<Expression> own = unfolding[orbit.signature[s].mode];
        for (Expression& one : own)
            if (one.empty())
                one = model.number(0);
        const std::vector<double> values = model.function_of(own)(concatenated(orbit.starts[s], orbit.parameters));
        result.segment(index(s * values.size()), index(values.size())) = vector_of(values);
    }
    return result;
}

/// Returns the unfoldings by all declared quantities. The named one comes first.
std::vector<Unfolding> unfoldings_by_conserved(Model& model, const std::string& first) {
    std::vector<ConservedQuantity> order = model.conserved;
    std::stable_partition(order.begin(), order.end(), [&](const ConservedQuantity& one) { return one.name == first; });
    std::vector<Unfolding> result;
    for (const ConservedQuantity& one : order)
        result.push_back(by_gradient(model, one));
    return result;
}

/// Returns those that are independent of the earlier ones along an orbit.
std::vector<Unfolding> independent(const Model& model, const std::vector<Unfolding>& all, const Orbit& orbit) {
    constexpr double dependent = 1e-6;
    std::vector<Unfolding> result;
    std::vector<Eigen::VectorXd> directions;
    for (const Unfolding& unfolding : all) {
        Eigen::VectorXd direction = values_at(model, unfolding, orbit);
        const double size = direction.norm();
        for (const Eigen::VectorXd& other : directions)
            direction -= other.dot(direction) * other;
        if (!(direction.norm() > dependent * size))
            continue;
        directions.push_back(direction.normalized());
        result.push_back(unfolding);
    }
    return result;
}

/// Adds a parameter that multiplies an unfolding in the rates.
void unfold(Model& model, const Unfolding& unfolding) {
    const Expression symbol = unused_symbol(model, "unfolding");
    model.parameters.push_back({.name = symbol.name(), .value = 0.0});
    for (std::size_t mode = 0; mode < model.modes.size(); ++mode)
        for (std::size_t i = 0; i < model.states.size(); ++i)
            if (const Expression& own = unfolding[mode][i]; !own.empty())
                model.modes[mode].rates[i] = model.modes[mode].rates[i] + symbol * own;
}

/// Returns states along an orbit, inside its smooth arcs.
std::vector<StateInMode> states_along(const System& system, const Orbit& orbit, double tolerance) {
    constexpr int count = 16; // of each arc
    const Simulation simulation(system, {}, {}, integration(tolerance));
    SegmentArcsFinder arcs_of(simulation);
    ModeFlow flow = flow_of(simulation);
    flow.set_parameters(orbit.parameters);
    std::vector<StateInMode> result;
    for (std::size_t s = 0; s < orbit.segments(); ++s) {
        const std::size_t mode = orbit.signature[s].mode;
        const SegmentArcs arcs = arcs_of(orbit, s);
        for (std::size_t i = 0; i < arcs.starts.size(); ++i) {
            std::vector<double> state = arcs.starts[i];
            for (int k = 0; k < count; ++k) {
                if (flow.run(mode, state, arcs.durations[i] / (count + 1)) != ModeFlow::Ending::done)
                    break;
                result.push_back({mode, state});
            }
        }
    }
    return result;
}

constexpr const char* if_not_conserved = "choose parameters at which it is, or correct the declaration";

/// Refuses what is followed or held as conserved, and is not, along an orbit. The equations would have a solution: the
/// orbit belongs to a family of whatever its motion does conserve.
void require_conserved(const System& system, const BranchSettings& settings, const Orbit& orbit) {
    const Model there = with_parameters(system.model(), orbit.parameters);
    std::vector<StateInMode> motion;
    for (const Monitor& monitor : settings.monitors) {
        const bool is_coordinate = settings.family && &monitor == &settings.monitors.back();
        const auto place = find_named(there.conserved, monitor.name);
        if (monitor.kind != Monitor::Kind::conserved || !(monitor.fixed || is_coordinate) || !place)
            continue;
        if (motion.empty())
            motion = states_along(system, orbit, settings.orbit.tolerance);
        if (const std::string why = why_not_conserved_along(there, *place, motion); !why.empty())
            throw InputError(why, if_not_conserved);
    }
}

/// Returns the orbit of a family that is nearest to a candidate. @param count number of directions that the equations
/// leave undetermined, at least @param detail set to the reason where there is none; empty if the orbit stands alone
std::optional<Orbit> nearest_member(const System& system, const Orbit& candidate, const OrbitOptions& options,
                                    std::size_t count, std::string& detail) {
    const Simulation simulation(system, {}, {}, integration(options.tolerance));
    Shooting shooting(simulation, candidate, {});
    Eigen::VectorXd unknowns = shooting.unknowns_of(candidate);
    OrbitEvaluation at = shooting.evaluation();
    std::size_t iterations = 0;
    // A state that contacts only reverse is held at its value, and determines one of the directions.
    const std::size_t held = shooting.evaluate(unknowns, at) ? moving_neutral_states(shooting, at) : 0;
    if (solve_equations(shooting, unknowns, options, at, iterations, detail, count - std::min(count, held)) !=
        OrbitOutcome::converged)
        return std::nullopt;
    detail.clear();
    Orbit orbit = shooting.orbit_of(unknowns);
    // Scales suit the orbit that was found.
    Shooting again(simulation, orbit, {});
    if (!again.evaluate(again.unknowns_of(orbit), at) ||
        (at.system.undetermined() == 0 && moving_neutral_states(again, at) == 0))
        return std::nullopt;
    return orbit;
}

/// Refuses settings that only a family could have.
void require_no_family(const BranchSettings& settings) {
    if (settings.conditions() != settings.free.size())
        throw InputError(fmt::format("{} monitors are fixed and {} further parameters are free, and the orbit is not "
                                     "one of a family at the same parameters",
                                     settings.fixed_monitors(), settings.free.size()),
                         "free one parameter for each monitor that is fixed");
}

/// @param why no orbit was found; empty if one was
[[noreturn]] void refuse(const Model& model, const FamilyCoordinate& family, const std::string& why_none) {
    for (std::size_t i = 0; i < model.conserved.size(); ++i)
        if (const std::string why = why_not_conserved(model, i); !why.empty())
            throw InputError(why, if_not_conserved);
    if (!why_none.empty())
        throw InputError(fmt::format("no orbit of a family was found: {}", why_none), "start nearer to an orbit");
    throw InputError(
        fmt::format("the orbit is isolated at its parameters: it is not one of a family along '{}'", family.name()),
        "take out what adds or removes energy, such as damping and forcing, start from another orbit, or "
        "follow a parameter of the model");
}

std::vector<ParameterId> last_parameters(const Model& model, std::size_t count) {
    std::vector<ParameterId> result;
    const std::vector<std::string> names = model.independent_parameters();
    for (std::size_t i = names.size() - count; i < names.size(); ++i)
        result.push_back(model.independent_parameter(names[i]));
    return result;
}

Monitor monitor_of(const Model& model, const FamilyCoordinate& coordinate) {
    if (!coordinate.conserved.empty())
        return monitor_of_conserved(model, coordinate.conserved);
    Monitor period;
    period.name = coordinate.name();
    period.unit = model.time_unit;
    return period;
}

/// Sets what the unfolded branch follows and holds, from what the branch of the model does.
void complete_settings(BranchSettings& settings, const Model& model, const std::vector<ParameterId>& unfolding) {
    settings.unfolded = unfolding.size();
    settings.free.insert(settings.free.end(), unfolding.begin(), unfolding.end());
    const std::size_t conditions = settings.conditions();
    if (settings.family) {
        Monitor& coordinate = settings.monitors.emplace_back(monitor_of(model, *settings.family));
        coordinate.least = settings.kept ? settings.family_least : settings.least;
        coordinate.greatest = settings.kept ? settings.family_greatest : settings.greatest;
        if (!settings.kept) { // the first unfolding parameter takes the place of that which varies
            settings.parameter = unfolding.front();
            std::erase(settings.free, unfolding.front());
            settings.least = settings.greatest = std::nullopt;
        }
    } else if (conditions < settings.free.size()) {
        // What is conserved stays as it is on branches along a parameter.
        Monitor& held = settings.monitors.emplace_back(monitor_of_conserved(model, model.conserved.front().name));
        held.fixed = true;
    }
}

/// Holds further conserved quantities where the orbit can move in fewer directions that change none of them than there
/// are parameters without a condition.
void hold_what_is_left(BranchSettings& settings, const System& system, Orbit orbit) {
    const Model& model = system.model();
    const std::size_t conditions = settings.conditions();
    if (conditions >= settings.free.size())
        return;
    std::size_t left = settings.free.size() - conditions;
    const Simulation simulation(system, {}, {}, integration(settings.orbit.tolerance));
    orbit.parameters.resize(model.independent_parameters().size(), 0.0);
    Shooting shooting(simulation, orbit, last_parameters(model, settings.unfolded));
    OrbitEvaluation at = shooting.evaluation();
    if (!shooting.evaluate(shooting.unknowns_of(orbit), at))
        return;
    left -= static_cast<std::size_t>(NeutralDirections(shooting)(shooting, at, left).cols());
    for (const ConservedQuantity& conserved : model.conserved) {
        const auto has_it = [&](const Monitor& one) {
            return one.kind == Monitor::Kind::conserved && one.name == conserved.name;
        };
        if (left == 0 || (settings.family && settings.family->conserved == conserved.name) ||
            std::ranges::any_of(settings.monitors, [&](const Monitor& one) { return one.fixed && has_it(one); }))
            continue;
        Monitor held = monitor_of_conserved(model, conserved.name);
        held.fixed = true;
        settings.monitors.insert(settings.monitors.end() - (settings.family ? 1 : 0),
                                 held); // the coordinate stays last
        --left;
    }
}

} // namespace

std::optional<Family> Family::of(const System& system, const Orbit& candidate, const BranchSettings& settings) {
    const bool may_conserve = !system.model().conserved.empty();
    if (settings.unfolded > 0 || (!settings.family && !may_conserve) || is_homoclinic(candidate.signature) ||
        candidate.cycle)
        return std::nullopt;
    settings.validate(system.model());
    validate_orbit(system.model(), candidate);
    if (is_rest(candidate.signature)) {
        if (settings.family)
            throw InputError(fmt::format("an equilibrium is no family along '{}'", settings.family->name()),
                             "follow a parameter of the model, or start from an orbit around the equilibrium");
        return std::nullopt;
    }
    const std::string first = settings.family ? settings.family->conserved : "";
    Model model = system.model();
    const std::vector<Unfolding> all = unfoldings_by_conserved(model, first);
    const std::size_t count = std::max(independent(model, all, candidate).size(), std::size_t{1});
    std::string detail;
    const std::optional<Orbit> start = nearest_member(system, candidate, settings.orbit, count, detail);
    if (!start) {
        if (settings.family)
            refuse(with_parameters(system.model(), candidate.parameters), *settings.family, detail);
        require_no_family(settings);
        return std::nullopt;
    }
    std::vector<Unfolding> unfoldings = independent(model, all, *start);
    if (unfoldings.empty())
        unfoldings.push_back(by_distance(model, system, *start, settings.orbit.tolerance));
    for (const Unfolding& one : unfoldings)
        unfold(model, one);
    BranchSettings unfolded = settings;
    complete_settings(unfolded, system.model(), last_parameters(model, unfoldings.size()));
    const System unfolded_system(model);
    hold_what_is_left(unfolded, unfolded_system, *start);
    require_conserved(system, unfolded, *start);
    Family family(unfolded_system, std::move(unfolded), system.model().independent_parameters().size(),
                  settings.monitors.size());
    family.settings_.validate(family.system_.model());
    family.start_ = family.unfolded(*start);
    return family;
}

Orbit Family::unfolded(Orbit orbit) const {
    orbit.parameters.resize(parameters_ + settings_.unfolded, 0.0);
    return orbit;
}

SpecialPoint Family::unfolded(SpecialPoint point) const {
    point.solution.orbit = unfolded(std::move(point.solution.orbit));
    return point;
}

Orbit Family::folded(Orbit orbit) const {
    orbit.parameters.resize(parameters_);
    return orbit;
}

/// Returns the value of the coordinate, and takes it and what is held from the monitors.
double Family::take_coordinate(const Orbit& orbit, std::vector<double>& monitors) const {
    double value = monitors.empty() ? 0 : monitors.back();
    if (is_coordinate() && monitors.empty())
        value =
            OrbitMonitors(system_, orbit.signature, {settings_.monitors.back()}, settings_.orbit.tolerance)(orbit)[0];
    monitors.resize(std::min(monitors.size(), monitors_));
    return value;
}

void Family::fold(BranchPoint& point) const {
    const double coordinate = take_coordinate(point.solution.orbit, point.monitors);
    if (is_coordinate())
        point.parameter = coordinate;
    point.solution.orbit = folded(std::move(point.solution.orbit));
}

void Family::fold(SpecialPoint& point, const BranchPoint& before, const BranchPoint& after) const {
    const double coordinate = take_coordinate(point.solution.orbit, point.monitors);
    if (is_coordinate()) {
        point.parameter = coordinate;
        point.bracket = std::minmax(before.parameter, after.parameter);
    }
    point.solution.orbit = folded(std::move(point.solution.orbit));
}

} // namespace graze
