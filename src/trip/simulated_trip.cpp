#include "graze/trip/simulated_trip.hpp"

#include "graze/base/input_error.hpp"
#include "orbit/certify.hpp"
#include "orbit/newton.hpp"
#include "trip/end_watch.hpp"
#include "trip/trip_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// The start of a motion near a touch, at the time of the touch.
struct TouchStart {
    std::vector<double> state, parameters;
    TouchMeeting meeting;
};

TripTime follow(const System& system, const CycleMap& map, TouchStart begin, const TripEnd& end,
                const TripOptions& options) {
    const TouchState& touch = map.contact.touch;
    const Simulation simulation = simulation_until(system, end, options);
    // A start beyond the surface is moved back to before its contact, which precedes the touch by speed over
    // acceleration.
    double early = 0;
    if (begin.meeting.gap < 0) {
        constexpr double earlier = 2, most = 0.05;
        early = std::min(earlier * begin.meeting.speed / map.contact.acceleration, most * map.time);
        ModeFlow flow(system, options.tolerance);
        flow.set_parameters(begin.parameters);
        if (flow.run(touch.mode, begin.state, -early) != ModeFlow::Ending::done) {
            TripTime trip;
            trip.ending = "undefined";
            return trip;
        }
    }
    // For half orbits the image of the touch may belong to another event. The orbit's other contacts do not count.
    const double period = map.half ? map.time : map.period;
    const auto counts = [&](const Contact& contact) {
        return (contact.event == map.touch.event ||
                (map.half && !is_identity_transition(system, contact.transition))) &&
               map.is_at_touch(contact.time - early, period);
    };
    EndWatch watch(end, counts, options.interrupted);
    TripTime trip =
        run_until(simulation, begin.parameters, begin.state, touch.mode, options.cycles * map.time + early, watch);
    trip.time -= early;
    trip.cycles = trip.time / map.time;
    return trip;
}

TouchStart touch_start_of(const System& system, const CycleMap& map, ParameterId parameter, double overshoot) {
    const TouchState& touch = map.contact.touch;
    if (touch.state.size() != system.states() || touch.parameters.size() != system.parameters())
        throw InputError("the map belongs to another model", "give the system that it was made from");
    TouchStart begin{touch.state, touch.parameters, {}};
    begin.parameters[parameter.place()] += overshoot;
    return begin;
}

void require_end(const TripEnd& end) {
    if (!(end.speed >= 0 && std::isfinite(end.speed)))
        throw InputError(fmt::format("the approach speed {} cannot be reached", end.speed), "give a positive one");
    if (!std::isfinite(end.level))
        throw InputError("the level is not finite", "give a number that the quantity passes");
}

} // namespace

void TripOptions::validate() const {
    if (!(cycles > 0 && cycles <= 1e9))
        throw InputError(fmt::format("{} cycles are not possible", cycles), "give up to 1e9");
    require_tolerance_in_range(tolerance);
    if (step_limit == 0)
        throw InputError("no steps are allowed", "give a limit of 1 or more");
}

double least_overshoot(const CycleMap& map, ParameterId parameter) {
    if (!map.exists() || !map.clearance_rate || *map.clearance_rate == 0)
        throw InputError("no parameter is known that moves the orbit from its touch",
                         "compute the map with a parameter");
    double size = 0;
    const TouchState& touch = map.contact.touch;
    for (std::size_t i = 0; i < touch.state.size(); ++i)
        size += std::abs(map.contact.gradient[i]) * touch.scales[i];
    // The touch itself is known to fewer digits than double precision has.
    constexpr double digits = 1e-15, enough = 1e3, state_resolution = 1e-11;
    return std::max(state_resolution * size / std::abs(*map.clearance_rate),
                    enough * digits * std::abs(touch.parameters[parameter.place()]));
}

TripTime simulated_trip(const System& system, const CycleMap& map, ParameterId parameter, double overshoot,
                        const TripEnd& end, const TripOptions& options) {
    options.validate();
    require_end(end);
    require_trip(map, overshoot, options.disturbance);
    TouchStart begin = touch_start_of(system, map, parameter, overshoot);
    for (std::size_t i = 0; i < options.disturbance.size(); ++i)
        begin.state[i] += options.disturbance[i];
    begin.meeting = meeting_of(map, overshoot, options.disturbance);
    return follow(system, map, std::move(begin), end, options);
}

TripTime continued_trip(const System& system, const CycleMap& map, ParameterId parameter, double overshoot,
                        const PredictedTrip& predicted, const TripEnd& end, const TripOptions& options) {
    if (predicted.handed_cycles == 0)
        return simulated_trip(system, map, parameter, overshoot, end, options);
    options.validate();
    require_end(end);
    require_trip(map, overshoot, options.disturbance);
    if (predicted.handed.size() != map.active.size())
        throw InputError("the prediction belongs to another map", "give the map that it was made from");
    TouchStart begin = touch_start_of(system, map, parameter, overshoot);
    begin.meeting.gap = *map.clearance_rate * overshoot;
    for (std::size_t i = 0; i < map.active.size(); ++i) {
        begin.state[map.active[i]] += map.steady[i] * overshoot + predicted.handed[i];
        begin.meeting.gap += map.gradient[i] * predicted.handed[i];
    }
    begin.meeting.speed = std::sqrt(std::max(0.0, -2 * map.contact.acceleration * begin.meeting.gap));
    TripTime trip = follow(system, map, std::move(begin), end, options);
    trip.time += predicted.handed_cycles * map.time;
    trip.cycles = trip.time / map.time;
    trip.contacts += predicted.handed_contacts;
    return trip;
}

TripTime simulate_until(const System& system, std::span<const double> parameters, std::span<const double> state,
                        std::size_t mode, double cycle, const TripEnd& end, const TripOptions& options) {
    options.validate();
    const Simulation simulation = simulation_until(system, end, options);
    // Contacts at all surfaces count.
    const auto counts = [&](const Contact& contact) {
        return system.model().events[contact.event].kind == EventKind::barrier;
    };
    EndWatch watch(end, counts, options.interrupted);
    TripTime trip = run_until(simulation, parameters, state, mode, options.cycles * cycle, watch);
    trip.cycles = trip.time / cycle;
    return trip;
}

} // namespace graze
