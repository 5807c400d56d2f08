#include "hybrid_case.hpp"

#include "../chain.hpp"
#include "../testbed.hpp"
#include "graze/model/microbeam.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace peers {

namespace {

/// Start phase at which neither contact nor mode change is near; motions end at the same phase.
constexpr double phase_of_start = 0.1;

struct ContactTimes : graze::Observer {
    std::vector<double> times;
    void contact(const graze::Contact& contact) override {
        if (contact.kind == graze::ContactKind::crossing)
            times.push_back(contact.time);
    }
};

std::vector<std::size_t> same_order(std::size_t states) {
    std::vector<std::size_t> order(states);
    std::iota(order.begin(), order.end(), std::size_t{0});
    return order;
}

/// Sets start and duration: after `settling` periods from the model's initial state.
void settle(HybridCase& one, double period, int settling, int periods) {
    const graze::Simulation simulation(graze::System(one.model), {}, {}, {.tolerance = 1e-13});
    graze::Trajectory trajectory(simulation, one.model.parameter_values());
    trajectory.start(one.model.initial_state(), one.model.initial_mode, 0, (settling + phase_of_start) * period);
    graze::JetSet jets(simulation, graze::LaneKind::single);
    run(trajectory, jets);
    if (trajectory.outcome().ending != graze::Ending::end_time)
        throw std::runtime_error(one.name + " does not settle: " + trajectory.outcome().detail);
    one.start.assign(trajectory.state().begin(), trajectory.state().end());
    one.mode = trajectory.mode();
    one.periods = periods;
    one.duration = periods * period;
    one.longest_step = period / 200;
}

/// Converts values of the model's states to the peers' order and units.
std::vector<double> for_peers(const HybridCase& one, const std::vector<double>& values) {
    std::vector<double> result(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        result[one.order[i]] = values[i] / one.units[i];
    return result;
}

double input_scale(const HybridCase& one, std::size_t input) {
    return input < one.scales.size() ? one.scales[input] : one.parameter_scale;
}

/// @param state, derivative of the peers, by their places
template <class State, class Derivative>
Outcome outcome_of_peer(const HybridCase& one, const std::vector<Meeting>& meetings, State&& state,
                        Derivative&& derivative) {
    Outcome result;
    const std::size_t states = one.scales.size();
    for (std::size_t i = 0; i + 1 < states; ++i)
        result.state.push_back(static_cast<double>(state(one.order[i])) * one.units[i] / one.scales[i]);
    for (std::size_t j = 0; j <= states; ++j) {
        const std::size_t input = j < states ? one.order[j] : states;
        const double unit = j < states ? one.units[j] : one.parameter_unit;
        std::vector<double>& column = result.derivatives.emplace_back();
        for (std::size_t i = 0; i < states; ++i)
            column.push_back(static_cast<double>(derivative(one.order[i], input)) * one.units[i] / unit *
                             input_scale(one, j) / one.scales[i]);
    }
    for (const Meeting& meeting : meetings)
        result.meetings.push_back(meeting.time * one.time_unit);
    return result;
}

double largest(const std::vector<double>& values) {
    double result = 0;
    for (const double value : values)
        result = std::max(result, std::abs(value));
    return result;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double result = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        result = std::fmax(result, std::abs(a[i] - b[i]));
    return result;
}

} // namespace

HybridCase chain_case(std::size_t oscillators, double force, int periods) {
    HybridCase one;
    one.name = "chain of " + std::to_string(oscillators) + (force < Chain::large_force ? "" : ", contacts");
    one.model = chain(oscillators, force);
    one.motions = chain_motions(oscillators, force);
    for (std::size_t i = 0; i < oscillators; ++i)
        one.order.push_back(1 + 2 * i);
    for (std::size_t i = 0; i < oscillators; ++i)
        one.order.push_back(2 + 2 * i);
    one.order.push_back(0);
    one.units.assign(2 * oscillators + 1, 1.0);
    one.scales = one.units;
    settle(one, 2 * std::numbers::pi / Chain::frequency, 40, periods);
    return one;
}

HybridCase beam_case(int modes, int periods) {
    const graze::MicrobeamOptions options{.modes = modes, .voltage = 0.032};
    HybridCase one;
    one.name = "microbeam, " + std::to_string(modes) + (modes == 1 ? " mode" : " modes");
    one.model = microbeam(options);
    one.parameter = one.model.independent_parameter("V").place();
    one.motions = beam_motions(options);
    const auto count = static_cast<std::size_t>(modes);
    one.order = same_order(2 * count + 1);
    one.units.assign(one.order.size(), 1.0);
    constexpr double deflection = 0.005;
    const graze::ClampedBeamModes beam(modes);
    one.scales.assign(count, deflection);
    one.scales.insert(one.scales.end(), count, deflection * beam.frequency(1));
    one.scales.push_back(1);
    one.parameter_scale = options.voltage;
    settle(one, 2 * std::numbers::pi / options.frequency, 60, periods);
    return one;
}

HybridCase testbed_case(int periods) {
    const Testbed testbed;
    const OdeintPeer::Parameters groups = testbed.groups();
    HybridCase one;
    one.name = "testbed, period 3";
    one.model = testbed.model;
    one.model.set_initial("I", 0.1);
    one.parameter = one.model.independent_parameter("V0").place();
    one.motions = testbed_motions(groups);
    one.order = same_order(4);
    const std::vector values = one.model.values_of(
        std::vector{one.model.symbol("beta2"), one.model.symbol("w0"), one.model.symbol("current_unit"),
                    one.model.symbol("voltage_unit"), one.model.symbol("V0")});
    one.units = {values[0], values[0] * values[1], values[2], 1};
    one.scales = one.units;
    one.time_unit = 1 / values[1];
    one.parameter_unit = values[3];
    one.parameter_scale = values[4];
    settle(one, Testbed::forcing_period, 600, periods);
    return one;
}

double error_of(const Outcome& outcome, const Outcome& reference) {
    double error = largest_difference(outcome.state, reference.state);
    for (std::size_t j = 0; j < reference.derivatives.size(); ++j)
        error = std::fmax(error, largest_difference(outcome.derivatives[j], reference.derivatives[j]) /
                                     largest(reference.derivatives[j]));
    return error;
}

double distance_of_meetings(const Outcome& one, const Outcome& other) {
    if (one.meetings.size() != other.meetings.size())
        return std::numeric_limits<double>::infinity();
    return largest_difference(one.meetings, other.meetings);
}

Outcome reference_of(const HybridCase& one) {
    using Real = Reference::Real;
    Reference reference(*one.motions.exact, Real(one.longest_step) / one.time_unit);
    reference.run(for_peers(one, one.start), one.mode, Real(one.duration) / one.time_unit);
    return outcome_of_peer(
        one, reference.meetings, [&](std::size_t i) { return reference.state(i); },
        [&](std::size_t i, std::size_t input) { return reference.derivative(i, input); });
}

Effort graze_effort(const HybridCase& one, double tolerance, double budget, const Outcome& reference,
                    Outcome& outcome) {
    const std::size_t states = one.scales.size(), inputs = states + one.model.parameter_values().size();
    const graze::Simulation simulation(graze::System(one.model), {}, {}, {.tolerance = tolerance});
    ContactTimes contacts;
    graze::Trajectory trajectory(simulation, one.model.parameter_values(), borrowed(contacts));
    graze::JetSet jets(simulation, graze::LaneKind::single);
    std::vector<double> seeds((states + 1) * inputs, 0.0);
    for (std::size_t j = 0; j <= states; ++j)
        seeds[j * inputs + (j < states ? j : states + one.parameter)] = 1;
    Effort effort{.tolerance = tolerance};
    effort.seconds = least_seconds(budget, [&] {
        contacts.times.clear();
        trajectory.start(one.start, one.mode, 0, one.duration);
        trajectory.carry_tangents(seeds, states + 1);
        run(trajectory, jets);
    });
    if (trajectory.outcome().ending != graze::Ending::end_time)
        throw std::runtime_error(one.name + ": " + trajectory.outcome().detail);
    outcome = {};
    outcome.meetings = contacts.times;
    for (std::size_t i = 0; i + 1 < states; ++i)
        outcome.state.push_back(trajectory.state()[i] / one.scales[i]);
    for (std::size_t j = 0; j <= states; ++j) {
        std::vector<double>& column = outcome.derivatives.emplace_back();
        for (std::size_t i = 0; i < states; ++i)
            column.push_back(trajectory.derivative(i, j) * input_scale(one, j) / one.scales[i]);
    }
    effort.error = error_of(outcome, reference);
    return effort;
}

Effort cvodes_effort(const HybridCase& one, CvodesMethod method, double tolerance, double budget,
                     const Outcome& reference, Outcome& outcome) {
    std::vector<double> inputs = for_peers(one, one.scales);
    const std::vector<double> states = inputs;
    inputs.push_back(one.parameter_scale / one.parameter_unit);
    CvodesPeer peer(*one.motions.motion, states, inputs, method, tolerance, true);
    const std::vector<double> start = for_peers(one, one.start);
    Effort effort{.tolerance = tolerance};
    effort.seconds = least_seconds(budget, [&] { peer.run(start, one.mode, one.duration / one.time_unit); });
    outcome = outcome_of_peer(
        one, peer.meetings(), [&](std::size_t i) { return peer.state()[i]; },
        [&](std::size_t i, std::size_t input) { return peer.derivatives()[input * start.size() + i]; });
    effort.error = error_of(outcome, reference);
    return effort;
}

} // namespace peers
