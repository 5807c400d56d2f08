#include "graze/trip/trip_origin.hpp"

#include "graze/base/input_error.hpp"
#include "graze/flow/mode_flow.hpp"
#include "orbit/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr double closing_tolerance = 1e-14;

void require_before(const System& system, ParameterId parameter, double value, double point, int side) {
    if (!std::isfinite(value))
        throw InputError("the value is not finite", "give one before the point");
    if ((value - point) * side >= 0)
        throw InputError(fmt::format("{} = {:.9g} is not before the point at {:.9g}: the motion is lost there",
                                     system.model().independent_parameters()[parameter.place()], value, point),
                         side > 0 ? "give a smaller value" : "give a greater value");
}

/// Follows an orbit to another value of the parameter, in as many steps as needed.
OrbitSolution followed_to(const System& system, Orbit orbit, ParameterId parameter, double value) {
    constexpr int most_parts = 64;
    OrbitSolution solution;
    const double start = orbit.parameters[parameter.place()];
    for (int parts = 1; parts <= most_parts; parts *= 2) {
        Orbit guess = orbit;
        bool found = true;
        for (int part = 1; part <= parts && found; ++part) {
            guess.parameters[parameter.place()] = part == parts ? value : start + (value - start) * part / parts;
            solution = solve_orbit(system, guess);
            found = solution.outcome == OrbitOutcome::converged;
            guess = solution.orbit;
        }
        if (found && is_stable(solution) && solution.certificate.admissible)
            return solution;
    }
    const std::string why = solution.outcome != OrbitOutcome::converged ? solution.detail
                            : !is_stable(solution)                      ? "it is not stable"
                                                                        : solution.certificate.reason;
    throw InputError(fmt::format("no stable orbit of the same kind is found at {} = {:.9g}{}{}",
                                 system.model().independent_parameters()[parameter.place()], value,
                                 why.empty() ? "" : ": ", why),
                     "give a value nearer to the point");
}

/// Returns the origin in the middle of the longest arc.
TripOrigin origin_on(const System& system, const Orbit& orbit, ParameterId parameter, double point) {
    TripOrigin origin;
    origin.parameter = parameter;
    origin.point = point;
    origin.value = orbit.parameters[parameter.place()];
    origin.cycle = orbit.return_time();
    origin.parameters = orbit.parameters;
    // The first of several arcs of equal length, up to round-off.
    constexpr double equal_length = 1 - 1e-9;
    const double most = equal_length * *std::ranges::max_element(orbit.durations);
    std::size_t longest = 0;
    while (longest + 1 < orbit.durations.size() && orbit.durations[longest] < most)
        ++longest;
    origin.mode = orbit.signature[longest].mode;
    origin.state = orbit.starts[longest];
    ModeFlow flow(system, closing_tolerance);
    flow.set_parameters(orbit.parameters);
    if (flow.run(origin.mode, origin.state, orbit.durations[longest] / 2) != ModeFlow::Ending::done)
        throw InputError("the orbit cannot be followed", "give a value nearer to the point");
    return origin;
}

} // namespace

bool TripOrigin::counts(const Contact& contact) const {
    return contact.event == event ||
           (half && contact.rate_after >= 0); // for the image, contacts that reverse the motion
}

TripOrigin trip_origin(const System& system, const Orbit& orbit, const CycleMap& map, ParameterId parameter,
                       double value) {
    if (!map.exists() || !map.clearance_rate || *map.clearance_rate == 0)
        throw InputError("no parameter is known that moves the orbit from its touch",
                         "compute the map with a parameter");
    const double point = map.contact.touch.parameters.at(parameter.place());
    require_before(system, parameter, value, point, *map.clearance_rate < 0 ? 1 : -1);
    const Orbit whole = whole_orbit(system, orbit);
    TripOrigin origin = origin_on(system, followed_to(system, whole, parameter, value).orbit, parameter, point);
    origin.cycle = map.half ? origin.cycle / 2 : origin.cycle;
    origin.event = map.contact.touch.event;
    origin.half = map.half;
    return origin;
}

/// Computes the origin near the fold by its normal form, then follows the branch from there.
TripOrigin trip_origin(const System& system, const FoldPassage& fold, double value) {
    require_before(system, fold.parameter, value, fold.value, fold.side);
    // Half of the gate.
    constexpr double share = 0.5;
    const double w = share * fold.gate;
    double near = fold.value - fold.side * fold.coefficient * w * w / std::abs(fold.rate);
    double along = w;
    if ((value - near) * fold.side > 0) {
        near = value;
        along = std::sqrt(std::abs(fold.rate * (value - fold.value)) / fold.coefficient);
    }
    Orbit guess = fold.orbit;
    guess.parameters[fold.parameter.place()] = near;
    std::vector<double> state = fold.orbit.starts.front();
    for (std::size_t i = 0; i < state.size(); ++i)
        state[i] -= along * fold.critical[i];
    constexpr double longer = 1.5; // slightly more than one cycle
    const Simulation simulation(system, {}, {}, integration(closing_tolerance));
    const FollowedMotion motion =
        follow_motion(simulation, guess.parameters, state, guess.signature.front().mode, longer * fold.cycle);
    const auto sections =
        std::ranges::any_of(guess.signature, [](const Segment& one) { return one.end != SegmentEnd::event; });
    if (!sections && motion.segments.size() >= guess.signature.size() &&
        std::equal(guess.signature.begin(), guess.signature.end(), motion.segments.begin())) {
        for (std::size_t k = 0; k < guess.signature.size(); ++k) {
            guess.starts[k] = motion.starts[k];
            guess.durations[k] = motion.durations[k];
        }
    } else {
        guess.starts.front() = state;
    }
    const OrbitSolution first = solve_orbit(system, guess);
    if (first.outcome == OrbitOutcome::converged)
        guess = first.orbit;
    return origin_on(system, followed_to(system, guess, fold.parameter, value).orbit, fold.parameter, fold.value);
}

TripOrigin trip_origin(const LossPoint& point, double value) {
    return point.fold ? trip_origin(point.system, *point.fold, value)
                      : trip_origin(point.system, point.orbit, point.map, point.parameter, value);
}

} // namespace graze
