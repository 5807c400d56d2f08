// Wrong uses of simulations, trajectories, their drivers and observers.

#include "misuse/valid_objects.hpp"
#include "misuse/wrong_use.hpp"

#include "graze/trajectory/ensemble.hpp"
#include "graze/trajectory/recorder.hpp"

// Omitted members of a struct have the defaults of its header.
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

namespace graze::trajectory_misuse_test {

using namespace graze::testing;

void wrong_trajectory_options(WrongUses& wrong) {
    using Options = SimulationOptions;
    const auto option = wrong.spoiled<Options>(
        [] { return Options(); },
        {{"simulation_options", &Options::validate},
         {"simulation_with", [](Options& o) { keep(Simulation(System(oscillator()), {}, {}, o)); }}});
    for (const double value : {0.0, -1.0, 1.0, 1e-17, not_a_number, infinity})
        option("tolerance_" + std::to_string(value), [value](SimulationOptions& o) { o.tolerance = value; });
    for (const int value : {-1, 1, 3, highest_order + 1, std::numeric_limits<int>::max()})
        option("order_" + std::to_string(value), [value](SimulationOptions& o) { o.order = value; });
    for (const auto& [kind, value] : negative()) {
        if (value != infinity)
            option("largest_step_" + kind, [value = value](SimulationOptions& o) { o.largest_step = value; });
        option("touch_" + kind, [value = value](SimulationOptions& o) { o.touch = value; });
    }
    option("step_limit_0", [](SimulationOptions& o) { o.step_limit = 0; });
    option("contacts_at_once_0", [](SimulationOptions& o) { o.contacts_at_once = 0; });
    option("contacts_at_once_negative", [](SimulationOptions& o) { o.contacts_at_once = -1; });
}

void probes(WrongUses& wrong) {
    const std::pair<std::string, std::function<void(Probe&)>> use = {
        "probe", [](Probe& p) { keep(Simulation(System(oscillator()), {p})); }};
    const auto probe =
        wrong.spoiled<Probe>([] { return Probe{.name = "probe", .expression = Graph::create()->symbol("x")}; }, {use});
    const auto phase = wrong.spoiled<Probe>(
        [] { return Probe{.kind = Probe::Kind::phase, .state = 2, .value = Graph::create()->number(1)}; }, {use});
    probe("by_default", [](Probe& p) { p = {}; });
    probe("extremum_of_nothing", [](Probe& p) { p = {.kind = Probe::Kind::extremum}; });
    probe("of_unknown", [](Probe& p) { p.expression = Graph::create()->symbol("unknown"); });
    probe("of_no_such_node", [](Probe& p) { p.expression = Expression(p.expression.graph(), 999); });
    probe("of_no_kind", [](Probe& p) { p.kind = static_cast<Probe::Kind>(9); });
    probe("in_no_direction", [](Probe& p) { p.direction = static_cast<Direction>(9); });
    phase("phase_without_value", [](Probe& p) { p.value = {}; });
    phase("phase_value_of_state", [](Probe& p) { p.value = Graph::create()->symbol("x"); });
    phase("phase_value_unknown", [](Probe& p) { p.value = Graph::create()->symbol("unknown"); });
    phase("phase_of_state_not_cyclic", [](Probe& p) { p.state = 0; });
    phase("phase_state", wrong_indices(3), [](Probe& p, std::size_t i) { p.state = i; });
    wrong("simulation_observing_nothing", [] { keep(Simulation(System(oscillator()), {}, {Expression()})); });
    wrong("simulation_observing_unknown",
          [] { keep(Simulation(System(oscillator()), {}, {Graph::create()->symbol("q")})); });
    wrong("series_of_probe", wrong_indices(0),
          [](std::size_t i) { keep(Simulation(System(oscillator())).series_of_probe(i)); });
    wrong("series_of_observed", wrong_indices(0),
          [](std::size_t i) { keep(Simulation(System(oscillator())).series_of_observed(i)); });
    wrong("moved_simulation", [] {
        Simulation simulation{System(oscillator())};
        const Simulation moved = std::move(simulation);
        keep(simulation.model().name);
    });
}

void starts(WrongUses& wrong) {
    wrong("trajectory_parameters", wrong_lengths(5), [](std::size_t length) {
        const Simulation simulation{System(oscillator())};
        keep(Trajectory(simulation, std::vector<double>(length)));
    });
    wrong("trajectory_parameter", not_finite(), [](Motion& m, double value) {
        std::vector<double> parameters = m.model.parameter_values();
        parameters[0] = value;
        Trajectory trajectory(m.simulation, parameters);
        trajectory.start(m.model.initial_state(), 0, 0, 1);
    });
    wrong("start_state", not_finite(), [](Motion& m, double value) {
        m.trajectory.start(std::vector<double>{value, 0, 0}, 0, 0, 1);
    });
    wrong("start_time", not_finite(),
          [](Motion& m, double value) { m.trajectory.start(m.model.initial_state(), 0, value, 1); });
    wrong("end_time", not_finite(),
          [](Motion& m, double value) { m.trajectory.start(m.model.initial_state(), 0, 0, value); });
    wrong("extend", not_finite(), [](Motion& m, double value) { m.finished().extend(value); });
    wrong("end_before_start", [](Motion& m) { m.trajectory.start(m.model.initial_state(), 0, 0, -1); });
    wrong("start_states", wrong_lengths(3),
          [](Motion& m, std::size_t length) { m.trajectory.start(std::vector<double>(length), 0, 0, 1); });
    wrong("start_mode", wrong_indices(2),
          [](Motion& m, std::size_t mode) { m.trajectory.start(m.model.initial_state(), mode, 0, 1); });
    wrong("period_that_is_negative_at_these_parameters", [] {
        Model model = oscillator();
        model.states[2].period = model.symbol("sigma");
        const Simulation simulation{System(model)};
        std::vector<double> parameters = model.parameter_values();
        parameters[model.independent_parameter("sigma").place()] = -1;
        Trajectory trajectory(simulation, parameters);
        trajectory.start(std::vector<double>(3), 0, 0, 1);
    });
    wrong("extend_to_the_past", [](Motion& m) { m.finished().extend(0.5); });
    wrong("extend_unfinished", [](Motion& m) { m.begun().extend(2); });
    wrong("limit_step_negative", [](Motion& m) { m.begun().limit_step(-1); });
    wrong("limit_step_nan", [](Motion& m) { m.begun().limit_step(not_a_number); });
}

void wrongly_carried(WrongUses& wrong) {
    wrong("carry_unknown", [](Motion& m) { m.begun().carry_derivatives({"unknown"}); });
    wrong("carry_empty_name", [](Motion& m) { m.begun().carry_derivatives({""}); });
    wrong("carry_definition", [](Motion& m) { m.begun().carry_derivatives({"force"}); });
    wrong("carry_seeds", wrong_lengths(8),
          [](Motion& m, std::size_t length) { m.begun().carry_tangents(std::vector<double>(length), 1); });
    wrong("carry_seeds", not_finite(),
          [](Motion& m, double value) { m.begun().carry_tangents(std::vector<double>(8, value), 1); });
    wrong("carry_directions_huge", [](Motion& m) { m.begun().carry_tangents(std::vector<double>(8), huge); });
    wrong("carry_directions_that_overflow", [](Motion& m) { m.begun().carry_tangents({}, std::size_t{1} << 61); });
    wrong("derivative_of_state", wrong_indices(3), [](Motion& m, std::size_t i) {
        m.begun().carry_derivatives({"x"});
        keep(m.trajectory.derivative(i, 0));
    });
    wrong("derivative_in_direction", wrong_indices(1), [](Motion& m, std::size_t i) {
        m.begun().carry_derivatives({"x"});
        keep(m.trajectory.derivative(0, i));
    });
    wrong("derivative_not_carried", [](Motion& m) { keep(m.finished().derivative(0, 0)); });
}

/// Calls in the wrong order: before the start, without a proposed step, or after the end.
void order_of_calls(WrongUses& wrong) {
    const auto jet = [](Motion& m) -> Jet& { return m.jets.computed(0, m.model.initial_state()); };
    const auto parameters = [](Motion& m) { m.jets.set_parameters(m.model.parameter_values()); };
    wrong("run_before_start", [](Motion& m) { run(m.trajectory, m.jets); });
    wrong("extend_before_start", [](Motion& m) { m.trajectory.extend(1); });
    wrong("carry_derivatives_before_start", [](Motion& m) { m.trajectory.carry_derivatives({"x"}); });
    wrong("carry_tangents_before_start", [](Motion& m) { m.trajectory.carry_tangents(std::vector<double>(8), 1); });
    wrong("derivative_before_start", [](Motion& m) { keep(m.trajectory.derivative(0, 0)); });
    wrong("propose_before_start", [=](Motion& m) {
        parameters(m);
        keep(m.trajectory.propose(jet(m), 0.1));
    });
    wrong("advance_before_start", [](Motion& m) { m.trajectory.advance(StepPreview(m.simulation, 1)); });
    wrong("advance_before_propose", [](Motion& m) { m.begun().advance(StepPreview(m.simulation, 1)); });
    wrong("propose_after_end", [=](Motion& m) {
        m.finished();
        keep(m.trajectory.propose(jet(m), 0.1));
    });
    wrong("advance_after_end", [](Motion& m) { m.finished().advance(StepPreview(m.simulation, 1)); });
    wrong("propose_lane", wrong_indices(1), [=](Motion& m, std::size_t lane) {
        parameters(m);
        keep(m.begun().propose(jet(m), 0.1, lane));
    });
    wrong("advance_lane", wrong_indices(1), [=](Motion& m, std::size_t lane) {
        parameters(m);
        keep(m.begun().propose(jet(m), 0.1));
        m.trajectory.advance(StepPreview(m.simulation, 1), lane);
    });
    wrong("propose_with_another_models_jet", [](Motion& m) {
        const Simulation other{System(load_model("mems-switch"))};
        JetSet jets(other, LaneKind::single);
        jets.set_parameters(other.model().parameter_values());
        keep(m.begun().propose(jets.computed(0, other.model().initial_state()), 0.1));
    });
    wrong("propose_with_another_order", [](Motion& m) {
        const Simulation other(System(m.model), {}, {}, {.order = 6});
        JetSet jets(other, LaneKind::single);
        jets.set_parameters(m.model.parameter_values());
        keep(m.begun().propose(jets.computed(0, m.model.initial_state()), 0.1));
    });
    wrong("advance_with_another_models_preview", [=](Motion& m) {
        parameters(m);
        keep(m.begun().propose(jet(m), 0.1));
        m.trajectory.advance(StepPreview(Simulation(System(load_model("mems-switch"))), 1));
    });
    wrong("run_with_another_simulations_jets", [](Motion& m) {
        JetSet jets(Simulation(System(load_model("mems-switch"))), LaneKind::single);
        run(m.begun(), jets);
    });
    wrong("run_with_jets_of_the_same_model", [](Motion& m) {
        JetSet jets(Simulation(System(m.model)), LaneKind::single);
        run(m.begun(), jets);
    });
    wrong("run_with_ensemble_jets", [](Motion& m) {
        JetSet jets(m.simulation, LaneKind::ensemble);
        run(m.begun(), jets);
    });
    const auto moved = [&](const std::string& name, const std::function<void(Motion&)>& use) {
        wrong("moved_trajectory_" + name, [use](Motion& m) {
            const Trajectory taken = std::move(m.begun());
            use(m);
        });
    };
    moved("start", [](Motion& m) { m.begun(); });
    moved("run", [](Motion& m) { run(m.trajectory, m.jets); });
    moved("extend", [](Motion& m) { m.trajectory.extend(2); });
    moved("carry", [](Motion& m) { m.trajectory.carry_derivatives({"x"}); });
}

void drivers(WrongUses& wrong) {
    wrong("jet_set_mode", wrong_indices(2), [](Motion& m, std::size_t i) { keep(m.jets(i)); });
    wrong("jet_set_next", wrong_indices(2), [](Motion& m, std::size_t i) { keep(m.jets.next(i)); });
    wrong("jet_set_computed", wrong_indices(2),
          [](Motion& m, std::size_t i) { keep(m.jets.computed(i, std::vector<double>(3))); });
    wrong("jet_set_parameters_of_mode", wrong_indices(2),
          [](Motion& m, std::size_t i) { m.jets.set_parameters(i, std::vector<double>(5)); });
    wrong("preview_mode", wrong_indices(2), [](Motion& m, std::size_t i) {
        m.jets.set_parameters(m.model.parameter_values());
        StepPreview preview(m.simulation, 1);
        Jet& jet = m.jets.computed(0, m.model.initial_state());
        preview.lengths()[0] = 0.01;
        preview.evaluate_ends(jet, m.jets.next(0), i);
    });
    wrong("jet_set_parameters", wrong_lengths(5),
          [](Motion& m, std::size_t n) { m.jets.set_parameters(std::vector<double>(n)); });
    wrong("jet_set_parameters_of_mode", wrong_lengths(5),
          [](Motion& m, std::size_t n) { m.jets.set_parameters(0, std::vector<double>(n)); });
    wrong("jet_set_computed_states", wrong_lengths(3),
          [](Motion& m, std::size_t n) { keep(m.jets.computed(0, std::vector<double>(n))); });
    wrong("jet_set_no_kind", [](Motion& m) { keep(JetSet(m.simulation, static_cast<LaneKind>(9))); });
    wrong("jet_set_no_set",
          [](Motion& m) { keep(JetSet(m.simulation, LaneKind::single, static_cast<InstructionSet>(9))); });
    wrong("ensemble_no_set", [](Motion& m) { keep(Ensemble(m.simulation, static_cast<InstructionSet>(9))); });
    for (const int width : {0, -1, std::numeric_limits<int>::min()})
        wrong("preview_width_" + std::to_string(width), [width](Motion& m) { keep(StepPreview(m.simulation, width)); });
    wrong("preview_of_another_width", [](Motion& m) {
        m.jets.set_parameters(m.model.parameter_values());
        StepPreview(m.simulation, 8).find_steps(m.jets.computed(0, m.model.initial_state()));
    });
    wrong("preview_length", wrong_indices(1),
          [](Motion& m, std::size_t i) { keep(StepPreview(m.simulation, 1).length(i)); });
    wrong("preview_agrees", wrong_indices(1),
          [](Motion& m, std::size_t i) { keep(StepPreview(m.simulation, 1).agrees(i)); });
    wrong("preview_state_lane", wrong_indices(1),
          [](Motion& m, std::size_t i) { keep(StepPreview(m.simulation, 1).state(2, i)); });
    wrong("preview_least_lane", wrong_indices(1),
          [](Motion& m, std::size_t i) { keep(StepPreview(m.simulation, 1).least(0, i)); });
    wrong("preview_size_lane", wrong_indices(1),
          [](Motion& m, std::size_t i) { keep(StepPreview(m.simulation, 1).size(0, i)); });
    wrong("ensemble_unstarted", [](Motion& m) { Ensemble(m.simulation).run(std::span(&m.trajectory, 1)); });
    wrong("ensemble_of_another_simulation",
          [](Motion& m) { Ensemble(Simulation(System(m.model))).run(std::span(&m.begun(), 1)); });
    wrong("ensemble_without_again", [](Motion& m) {
        std::vector<Trajectory*> slots = {&m.begun()};
        Ensemble(m.simulation).run(slots, {});
    });
    wrong("ensemble_same_trajectory_twice", [](Motion& m) {
        std::vector<Trajectory*> slots(2, &m.begun());
        Ensemble(m.simulation).run(slots, [](std::size_t) { return nullptr; });
    });
    wrong("ensemble_again_unstarted", [](Motion& m) {
        std::vector<Trajectory*> slots = {&m.begun()};
        Trajectory other(m.simulation, m.model.parameter_values());
        bool given = false;
        Ensemble(m.simulation).run(slots, [&](std::size_t) { return std::exchange(given, true) ? nullptr : &other; });
    });
    wrong("ensemble_again_of_another_simulation", [](Motion& m) {
        std::vector<Trajectory*> slots = {&m.begun()};
        Motion other;
        other.begun();
        Ensemble(m.simulation).run(slots, [&](std::size_t) { return &other.trajectory; });
    });
    wrong("ensemble_again_what_runs_elsewhere", [](Motion& m) {
        Trajectory other(m.simulation, m.model.parameter_values());
        other.start(m.model.initial_state(), 0, 0, 5);
        std::vector<Trajectory*> slots = {&m.begun(0.1), &other};
        bool given = false;
        Ensemble(m.simulation).run(slots, [&](std::size_t) { return std::exchange(given, true) ? nullptr : &other; });
    });
    wrong("ensemble_moved_trajectory", [](Motion& m) {
        const Trajectory taken = std::move(m.begun());
        Ensemble(m.simulation).run(std::span(&m.trajectory, 1));
    });
}

void observers(WrongUses& wrong) {
    const auto receiver = [](double, std::size_t, std::span<const double>) {};
    wrong("relay_to_nobody", [] { Relay({nullptr}).step({}); });
    wrong("sampler_spacing", not_positive(), [receiver](double value) {
        keep(Sampler(0, value, 3, {0, 0, 0}, receiver));
    });
    wrong("sampler_start", not_finite(), [receiver](double value) { keep(Sampler(value, 1, 3, {0, 0, 0}, receiver)); });
    wrong("sampler_without_receiver", [] { keep(Sampler(0, 1, 3, {0, 0, 0}, {})); });
    wrong("sampler_period_negative", [receiver] { keep(Sampler(0, 1, 3, {-1, 0, 0}, receiver)); });
    wrong("sampler_period_nan", [receiver] { keep(Sampler(0, 1, 3, {not_a_number, 0, 0}, receiver)); });
    wrong("sampler_periods", wrong_lengths(3), [receiver](Motion& m, std::size_t n) {
        Sampler sampler(0, 0.1, 5, std::vector<double>(n), receiver);
        Trajectory trajectory(m.simulation, m.model.parameter_values(), borrowed(sampler));
        trajectory.start(m.model.initial_state(), 0, 0, 1);
        run(trajectory, m.jets);
    });
    wrong("arc_minima_without_receiver", [](Motion& m) {
        const Simulation simulation(System(m.model), {}, {}, {.minima = true});
        ArcMinima minima{{}};
        Trajectory trajectory(simulation, m.model.parameter_values(), borrowed(minima));
        trajectory.start(m.model.initial_state(), 0, 0, 1);
        JetSet jets(simulation, LaneKind::single);
        run(trajectory, jets);
        minima.finish();
    });
    wrong("step_state_of_no_step", [] { keep(Step().state(0, 0.1)); });
    wrong("name_of_no_ending", [] { keep(std::string(name_of(static_cast<Ending>(99)))); });
}

TEST(WrongTrajectoryUse, IsRefused) {
    expect_refusals({wrong_trajectory_options, probes, starts, wrongly_carried, order_of_calls, drivers, observers});
}

} // namespace graze::trajectory_misuse_test
