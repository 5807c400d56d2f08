// Correct uses that must work: temporaries passed to constructors, and objects that outlive those they were made from.

#include "misuse/valid_objects.hpp"
#include "misuse/wrong_use.hpp"

#include "graze/record/calibrated.hpp"
#include "graze/study/runner.hpp"
#include "graze/sweep/plan.hpp"
#include "graze/symbolic/transform.hpp"
#include "graze/trajectory/ensemble.hpp"
#include "graze/trajectory/recorder.hpp"
#include "graze/trajectory/run_control.hpp"

#include <memory>
#include <optional>
#include <utility>

// Omitted members of a struct have the defaults of its header.
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

namespace graze::lifetime_test {

using namespace graze::testing;

/// Runs a trajectory after all objects that it was made from, except its observer, have been destroyed.
void run_alone(Trajectory& trajectory) {
    trajectory.start(oscillator().initial_state(), 0, 0, 1);
    JetSet jets(trajectory.simulation(), LaneKind::single);
    run(trajectory, jets);
    if (trajectory.outcome().ending != Ending::end_time)
        throw OrderError(trajectory.outcome().detail);
}

void outlived_expressions(WrongUses& right) {
    right("expression_outlives_graph_handle", [] { keep(to_string(sin(Graph::create()->symbol("x")) + 1)); });
    right("expression_outlives_model", [] {
        const Expression force = oscillator().definitions[0].value;
        keep(to_string(differentiate(force, force.graph()->symbol("v"))));
    });
    right("function_outlives_graph", [] {
        Function function;
        {
            const Expression x = Graph::create()->symbol("x");
            function = Function(std::vector{x}, std::vector{x * x});
        }
        EXPECT_EQ(function(std::vector<double>{3})[0], 9);
    });
    right("function_of_temporary_vectors", [] {
        const Model model = oscillator();
        keep(Function(model.inputs(), std::vector{model.symbol("x") * 2.0})(std::vector<double>(8, 1.0)));
    });
    right("jet_outlives_tape_and_graph", [] {
        std::unique_ptr<Jet> jet;
        {
            const Expression x = Graph::create()->symbol("x");
            jet = make_jet(compile_tape(std::vector{x}, {}, std::vector{x}, {}), 5, LaneKind::single);
        }
        jet->compute(std::vector<double>{1});
        EXPECT_EQ(jet->state(0)[1], 1);
    });
    right("copied_model_outlives_original", [] {
        std::optional<Model> model = oscillator();
        const Model copy = *model;
        model.reset();
        copy.validate();
    });
    right("assigned_to_moved_model", [] {
        Model model = oscillator();
        const Model moved = std::move(model);
        model = moved;
        model.validate();
    });
    right("model_assigned_to_itself", [] {
        Model model = oscillator();
        const Model& same = model;
        model = same;
        model.validate();
    });
}

void outlived_systems(WrongUses& right) {
    right("system_outlives_model", [] {
        std::optional<Model> model = oscillator();
        const System system(*model);
        model.reset();
        keep(Simulation(system));
        EXPECT_EQ(system.model().states.size(), 3U);
    });
    right("model_changes_after_compilation", [] {
        Model model = oscillator();
        const System system(model);
        model.states.clear();
        EXPECT_EQ(system.model().states.size(), 3U);
    });
    right("observing_system_outlives_first", [] {
        std::optional<System> first = System(oscillator());
        const System observing = first->observing(std::vector{Graph::create()->symbol("x")});
        first.reset();
        EXPECT_EQ(observing.observed(), 1U);
        keep(observing.mode(1).tape.outputs.size());
    });
    right("mode_of_another_handle", [] {
        std::optional<System> first = System(oscillator());
        const System second = *first;
        const System::CompiledMode& mode = first->mode(0);
        first.reset();
        EXPECT_EQ(mode.rates.outputs(), second.states());
    });
    right("function_of_system_outlives_it", [] {
        const Function function = System(oscillator()).function_of(std::vector{Graph::create()->symbol("x")});
        EXPECT_EQ(function(std::vector<double>(8, 2.0))[0], 2);
    });
    right("step_check_outlives_system", [] {
        StepCheck check(System(oscillator()), 10, 1e-10);
        check.set_parameters(oscillator().parameter_values());
    });
    right("simulation_of_temporaries", [] {
        const Simulation simulation(System(oscillator()), {section_probe(oscillator(), "turning")},
                                    {Graph::create()->symbol("v")});
        EXPECT_EQ(simulation.probes().size(), 1U);
    });
    right("model_of_a_simulation_copied", [] {
        Model model = Simulation(System(oscillator())).model();
        keep(model.symbol("new"));
    });
}

void trajectories(WrongUses& right) {
    right("trajectory_of_temporaries", [] {
        Trajectory trajectory(Simulation(System(oscillator())), oscillator().parameter_values());
        run_alone(trajectory);
    });
    right("trajectory_of_temporaries_with_probes", [] {
        Trajectory trajectory(Simulation(System(oscillator()), {section_probe(oscillator(), "turning")}),
                              oscillator().parameter_values(), std::make_shared<Recorder>());
        run_alone(trajectory);
    });
    right("trajectory_outlives_shares_of_its_observers", [] {
        auto recorder = std::make_shared<Recorder>();
        auto relay = std::make_shared<Relay>(std::vector<std::shared_ptr<Observer>>{recorder});
        Trajectory trajectory(Simulation(System(oscillator())), oscillator().parameter_values(),
                              std::make_shared<RunControl>(std::move(relay), std::nullopt, std::vector{true}));
        recorder.reset();
        run_alone(trajectory);
    });
    right("trajectory_outlives_simulation", [] {
        std::optional<Simulation> simulation = Simulation(System(oscillator()));
        Trajectory trajectory(*simulation, oscillator().parameter_values());
        simulation.reset();
        run_alone(trajectory);
    });
    right("moved_trajectory_goes_on", [] {
        Motion motion;
        motion.begun();
        Trajectory moved = std::move(motion.trajectory);
        run(moved, motion.jets);
        moved.extend(2);
        run(moved, motion.jets);
        EXPECT_EQ(moved.outcome().ending, Ending::end_time);
    });
    right("moved_trajectory_keeps_derivatives", [] {
        Motion motion;
        motion.begun().carry_derivatives({"x"});
        Trajectory moved = std::move(motion.trajectory);
        run(moved, motion.jets);
        keep(moved.derivative(0, 0));
    });
    right("start_from_own_state", [] {
        Motion motion;
        const std::span<const double> state = motion.finished().state();
        motion.trajectory.start(state, motion.trajectory.mode(), 0, 1);
        run(motion.trajectory, motion.jets);
    });
    right("parameters_of_another_trajectory", [] {
        std::optional<Motion> motion(std::in_place);
        Trajectory trajectory(motion->simulation, motion->trajectory.parameters());
        motion.reset();
        run_alone(trajectory);
    });
    right("temporary_seeds", [] {
        Motion motion;
        motion.begun().carry_tangents(std::vector<double>(8, 1.0), 1);
        run(motion.trajectory, motion.jets);
        keep(motion.trajectory.derivative(0, 0));
    });
    right("jet_set_outlives_simulation", [] {
        JetSet jets(Simulation(System(oscillator())), LaneKind::single);
        Trajectory trajectory(jets.simulation(), oscillator().parameter_values());
        trajectory.start(oscillator().initial_state(), 0, 0, 1);
        run(trajectory, jets);
    });
    right("jet_set_with_temporary_parameters", [] {
        JetSet jets(Simulation(System(oscillator())), LaneKind::single);
        jets.set_parameters(oscillator().parameter_values());
        jets.computed(1, std::vector<double>(3, 0.1));
    });
    right("preview_outlives_simulation", [] {
        StepPreview preview(Simulation(System(oscillator())), 1);
        JetSet jets(Simulation(System(oscillator())), LaneKind::single);
        jets.set_parameters(oscillator().parameter_values());
        preview.lengths()[0] = 0;
        preview.find_steps(jets.computed(0, oscillator().initial_state()));
    });
    right("ensemble_outlives_simulation", [] {
        std::optional<Simulation> simulation = Simulation(System(oscillator()));
        Ensemble ensemble(*simulation);
        std::vector<Trajectory> trajectories;
        for (int i = 0; i < 5; ++i) {
            trajectories.emplace_back(*simulation, oscillator().parameter_values());
            trajectories.back().start(oscillator().initial_state(), 0, 0, 1);
        }
        simulation.reset();
        ensemble.run(trajectories);
        for (const Trajectory& trajectory : trajectories)
            EXPECT_TRUE(trajectory.finished());
    });
    right("ensemble_of_nothing", [] { Ensemble(Simulation(System(oscillator()))).run(std::span<Trajectory>{}); });
}

void outlived_searches(WrongUses& right) {
    right("search_outlives_factory_and_model", [] {
        std::unique_ptr<PointSearch> search;
        {
            const Model model = oscillator();
            search = transient_searches(System(model), {.time = 0.1}, {{.name = "a", .section = "phase0"}},
                                        {model.symbol("x")}, {})
                         ->make();
        }
        search->begin(oscillator().parameter_values(), oscillator().initial_state(), 0);
        run(search->trajectory(), *std::make_unique<JetSet>(search->trajectory().simulation(), LaneKind::single));
        while (search->proceed())
            run(search->trajectory(), *std::make_unique<JetSet>(search->trajectory().simulation(), LaneKind::single));
        EXPECT_EQ(search->result().label, Label::ended);
    });
    right("attractor_search_of_temporaries", [] {
        keep(attractor_searches(System(oscillator()), by_phase(), {{.name = "a", .section = "phase0"}},
                                {oscillator().symbol("v")}, {}));
    });
    right("execution_of_temporaries", [] {
        std::size_t done = 0;
        EXPECT_TRUE(
            execute({.chains = 3,
                     .start =
                         [](std::size_t) {
                             return PointStart{oscillator().parameter_values(), oscillator().initial_state(), 0};
                         }},
                    *transient_searches(System(oscillator()), {.time = 0.1}, {}, {}, {}), {}, {.jobs = 2},
                    [&](auto&&...) { ++done; }));
        EXPECT_EQ(done, 3U);
    });
    right("find_orbit_of_temporaries", [] { keep(find_orbit(System(calm_oscillator()), by_phase())); });
    right("solve_orbit_of_temporaries", [] { keep(solve_orbit(System(calm_oscillator()), calm_orbit())); });
    right("orbit_monitors_outlive_model", [] {
        OrbitMonitors monitors(
            System(calm_oscillator()), calm_orbit().signature,
            {{.name = "m", .kind = Monitor::Kind::mean, .expression = calm_oscillator().symbol("x")}});
        OrbitMonitors moved = std::move(monitors);
        keep(moved(calm_orbit()));
    });
    right("orbit_branch_of_temporaries", [] {
        OrbitBranch branch(System(calm_oscillator()), calm_orbit(), by_amplitude());
        EXPECT_TRUE(branch.start());
        EXPECT_TRUE(branch.step());
    });
    right("moved_orbit_branch_goes_on", [] {
        OrbitBranch branch(System(calm_oscillator()), calm_orbit(), by_amplitude());
        EXPECT_TRUE(branch.start());
        OrbitBranch moved = std::move(branch);
        EXPECT_TRUE(moved.step());
    });
    right("orbit_branch_outlives_the_one_its_start_came_from", [] {
        const std::vector<BranchStart> starts = branches_at(System(calm_oscillator()), grazing_point(), by_amplitude());
        OrbitBranch branch(System(calm_oscillator()), BranchStart(starts.at(0)).orbit, by_amplitude());
        EXPECT_TRUE(branch.start_along(BranchStart(starts.at(0)).direction, starts.at(0).distance));
    });
    right("follow_branch_of_temporaries", [] {
        keep(follow_branch(System(calm_oscillator()), Orbit(calm_orbit()), by_amplitude(),
                           [](const BranchPoint&, const std::vector<SpecialPoint>&) { return false; }));
    });
    right("dense_problem_of_temporary_functions", [] {
        DenseProblem problem(2, [offset = std::vector<double>{1}](std::span<const double> u, std::span<double> values) {
            values[0] = u[0] + u[1] - offset[0];
            return true;
        });
        Continuation continuation(borrowed(problem));
        EXPECT_TRUE(continuation.start(std::vector<double>{1, 0}, 1, 1));
        EXPECT_TRUE(continuation.step());
        EXPECT_TRUE(continuation.start_at(continuation.point().u, continuation.point().tangent));
    });
    right("continuation_outlives_shares_of_its_problem", [] {
        Continuation continuation(
            std::make_shared<DenseProblem>(2, [](std::span<const double> u, std::span<double> values) {
                values[0] = u[0] + u[1] - 1;
                return true;
            }));
        EXPECT_TRUE(continuation.start(std::vector<double>{1, 0}, 1, 1));
        EXPECT_TRUE(continuation.step());
    });
    right("stages_of_a_record_keep_their_sources", [] {
        std::shared_ptr<SampleSource> source =
            std::make_shared<StoredSamples>(RecordHeader{{"t", "s"}, {{"x", "m"}}}, Samples{{0, 1, 2}, {{1, 2, 3}}});
        source = std::make_shared<Calibrated>(std::move(source), CalibratedSettings{{{0, 2, 0, {}}}});
        source = std::make_shared<Calibrated>(std::move(source), CalibratedSettings{.begin = 0.5});
        EXPECT_EQ(read_all(*source, 10).values[0], (std::vector<double>{4, 6}));
    });
    right("plan_outlives_run", [] {
        std::optional<StudyRun> run(std::in_place);
        run->kind = RunKind::sweep;
        run->model = oscillator();
        run->motion().axes.emplace_back();
        run->motion().axes[0].values = {1, 2};
        run->motion().axes[0].parameter = run->model.independent_parameter("amplitude");
        const Plan plan = plan_of(*run, System(run->model), nullptr);
        run.reset();
        keep(plan.start(plan.points() - 1));
    });
    right("follow_motion_of_temporaries", [] {
        keep(follow_motion(Simulation(System(oscillator())), oscillator().parameter_values(),
                           oscillator().initial_state(), 0, 1));
    });
}

TEST(Lifetime, ObjectsOutliveThoseTheyWereMadeFrom) {
    WrongUses right;
    for (const auto add : {outlived_expressions, outlived_systems, trajectories, outlived_searches})
        add(right);
    each_of(right.list(), [](const auto& use) { EXPECT_NO_THROW(use.use()) << use.name; });
}

} // namespace graze::lifetime_test
