// Wrong uses of tapes, jets, steps, roots, systems and flows.

#include "misuse/valid_objects.hpp"
#include "misuse/wrong_use.hpp"

#include "graze/flow/mode_flow.hpp"
#include "graze/flow/second_order_flow.hpp"
#include "graze/flow/step_check.hpp"
#include "graze/flow/step_size.hpp"
#include "graze/flow/tangent_steps.hpp"
#include "graze/symbolic/transform.hpp"

namespace graze::flow_misuse_test {

using namespace graze::testing;

/// x' = y, y' = -k x with the outputs x + y, x y: two states, one parameter.
struct Pendulum {
    std::shared_ptr<Graph> graph = Graph::create();
    Expression x = graph->symbol("x"), y = graph->symbol("y"), k = graph->symbol("k");
    std::vector<Expression> states = {x, y}, parameters = {k}, rates = {y, -k*x}, outputs = {x + y, x*y};
    Tape tape() const { return compile_tape(states, parameters, rates, outputs); }
    std::unique_ptr<Jet> jet(LaneKind kind = LaneKind::single, int order = 8) const {
        std::unique_ptr<Jet> made = make_jet(tape(), order, kind);
        const auto width = static_cast<std::size_t>(made->width());
        made->set_parameters(std::vector<double>(width, 1.0));
        made->compute(std::vector<double>(2 * width, 0.5));
        return made;
    }
};

void tapes(WrongUses& wrong) {
    const auto compile =
        wrong.spoiled<Pendulum>([] { return Pendulum(); }, {{"compile_tape", [](Pendulum& p) { keep(p.tape()); }}});
    compile("state_nothing", [](Pendulum& p) { p.states[0] = {}; });
    compile("parameter_nothing", [](Pendulum& p) { p.parameters[0] = {}; });
    compile("rate_nothing", [](Pendulum& p) { p.rates[0] = {}; });
    compile("output_nothing", [](Pendulum& p) { p.outputs[0] = {}; });
    compile("all_nothing", [](Pendulum& p) {
        p.states = p.rates = {Expression()};
        p.parameters = p.outputs = {};
    });
    compile("state_no_symbol", [](Pendulum& p) { p.states[0] = p.x * p.y; });
    compile("parameter_no_symbol", [](Pendulum& p) { p.parameters[0] = p.x * p.y; });
    compile("state_twice", [](Pendulum& p) { p.states[0] = p.y; });
    compile("parameter_is_state", [](Pendulum& p) { p.parameters[0] = p.y; });
    compile("rate_unknown", [](Pendulum& p) { p.rates[0] = p.graph->symbol("unknown"); });
    compile("output_unknown", [](Pendulum& p) { p.outputs[0] = p.graph->symbol("unknown"); });
    compile("rates_too_few", [](Pendulum& p) { p.rates.pop_back(); });
    compile("rates_too_many", [](Pendulum& p) { p.rates.push_back(p.x); });
    compile("rates_none", [](Pendulum& p) { p.rates.clear(); });
    compile("states_none", [](Pendulum& p) { p.states.clear(); });
    compile("rate_of_another_graph", [](Pendulum& p) { p.rates[0] = Graph::create()->symbol("y"); });
    compile("state_of_another_graph", [](Pendulum& p) { p.states[0] = Graph::create()->symbol("x"); });
    compile("rate_no_such_node", [](Pendulum& p) { p.rates[0] = Expression(p.graph, 999); });

    for (const int order : {0, -1, highest_order + 1, std::numeric_limits<int>::max()})
        wrong("make_jet_order_" + std::to_string(order),
              [order] { keep(make_jet(Pendulum().tape(), order, LaneKind::single)); });
    wrong("make_jet_no_kind", [] { keep(make_jet(Pendulum().tape(), 8, static_cast<LaneKind>(9))); });
    wrong("make_jet_no_set",
          [] { keep(make_jet(Pendulum().tape(), 8, LaneKind::single, static_cast<InstructionSet>(9))); });
    wrong("lanes_of_no_kind", [] { keep(lanes_of(static_cast<LaneKind>(9), InstructionSet::baseline)); });
    wrong("lanes_of_no_set", [] { keep(lanes_of(LaneKind::ensemble, static_cast<InstructionSet>(9))); });
    wrong("name_of_no_set", [] { keep(std::string(name_of(static_cast<InstructionSet>(9)))); });
    const auto by_hand =
        wrong.spoiled<Tape>([] { return Pendulum().tape(); },
                            {{"make_jet_tape", [](Tape& tape) {
                                  make_jet(tape, 8, LaneKind::single)->compute(std::vector<double>(tape.states, 0.5));
                              }}});
    by_hand("register_that_is_not_there", [](Tape& t) { t.code.at(0).result = 1'000'000; });
    by_hand("output_that_is_not_there", [](Tape& t) { t.outputs.at(0).index = 1'000'000; });
    by_hand("rate_that_is_not_there", [](Tape& t) { t.rates.at(0).index = 1'000'000; });
    by_hand("without_rates", [](Tape& t) { t.rates.clear(); });
    by_hand("without_degrees", [](Tape& t) { t.degrees.clear(); });
    by_hand("term_that_is_not_there", [](Tape& t) { t.terms.at(0).series = 1'000'000; });
    by_hand("literal_that_is_not_there", [](Tape& t) { t.literals.push_back({1'000'000, 1.0}); });
}

void wrong_jets(WrongUses& wrong) {
    for (const LaneKind kind : {LaneKind::single, LaneKind::ensemble}) {
        const std::string of = "jet_" + std::to_string(static_cast<int>(kind)) + "_";
        const std::size_t width =
            kind == LaneKind::single ? 1 : static_cast<std::size_t>(Pendulum().jet(kind)->width());
        using Numbers = std::vector<double>;
        const auto count = [&](const std::string& name, std::size_t right,
                               const std::function<void(Jet&, Numbers&, std::size_t)>& use) {
            for (const auto& [how, length] : wrong_lengths(right))
                wrong(of + name + "_" + how, [kind, use, length = length, width] {
                    const std::unique_ptr<Jet> jet = Pendulum().jet(kind);
                    Numbers numbers(length, 0.1);
                    use(*jet, numbers, width);
                });
        };
        count("set_parameters", width, [](Jet& jet, Numbers& n, std::size_t) { jet.set_parameters(n); });
        count("compute", 2 * width, [](Jet& jet, Numbers& n, std::size_t) { jet.compute(n); });
        count("begin", 2 * width, [](Jet& jet, Numbers& n, std::size_t) { jet.begin(n); });
        count("evaluate_times", width, [](Jet& jet, Numbers& n, std::size_t w) {
            Numbers values(2 * w);
            jet.evaluate_states(n, values);
        });
        count("evaluate_values", 2 * width,
              [](Jet& jet, Numbers& n, std::size_t w) { jet.evaluate_states(Numbers(w, 0.1), n); });
        count("slopes_times", width, [](Jet& jet, Numbers& n, std::size_t w) {
            Numbers values(2 * w), slopes(2 * w);
            jet.evaluate_states(n, values, slopes);
        });
        count("slopes_values", 2 * width, [](Jet& jet, Numbers& n, std::size_t w) {
            Numbers slopes(2 * w);
            jet.evaluate_states(Numbers(w, 0.1), n, slopes);
        });
        count("slopes_slopes", 2 * width, [](Jet& jet, Numbers& n, std::size_t w) {
            Numbers values(2 * w);
            jet.evaluate_states(Numbers(w, 0.1), values, n);
        });
        count("evaluate_output_times", width, [](Jet& jet, Numbers& n, std::size_t w) {
            Numbers values(w);
            jet.evaluate_output(0, n, values);
        });
        count("evaluate_output_values", width,
              [](Jet& jet, Numbers& n, std::size_t w) { jet.evaluate_output(0, Numbers(w, 0.1), n); });
        for (const auto& [how, index] : wrong_indices(2)) {
            const auto with = [&, what = how, i = index](const std::string& name,
                                                         const std::function<void(Jet&, std::size_t)>& use) {
                wrong(of + name + "_" + what, [kind, use, index = i] { use(*Pendulum().jet(kind), index); });
            };
            with("state", [](Jet& jet, std::size_t i) { keep(jet.state(i)); });
            with("output", [](Jet& jet, std::size_t i) { keep(jet.output(i)); });
            with("evaluate_output", [width](Jet& jet, std::size_t i) {
                Numbers values(width);
                jet.evaluate_output(i, Numbers(width, 0.1), values);
            });
        }
        count("find_steps_references", width, [](Jet& jet, Numbers& n, std::size_t w) {
            Numbers steps(w);
            jet.find_steps(-40, n, steps);
        });
        count("find_steps_steps", width,
              [](Jet& jet, Numbers& n, std::size_t w) { jet.find_steps(-40, Numbers(w, 0.1), n); });
        count("guard_steps", width, [](Jet& jet, Numbers& n, std::size_t) { jet.guard_steps(n); });
        count("bound_outputs_lengths", width, [](Jet& jet, Numbers& n, std::size_t w) {
            Numbers least(2 * w), sizes(2 * w);
            jet.bound_outputs(n, least, sizes);
        });
        wrong(of + "bound_outputs_too_many", [kind, width] {
            Numbers least(3 * width), sizes(3 * width);
            Pendulum().jet(kind)->bound_outputs(Numbers(width, 0.1), least, sizes);
        });
        wrong(of + "bound_outputs_unequal", [kind, width] {
            Numbers least(2 * width), sizes(width);
            Pendulum().jet(kind)->bound_outputs(Numbers(width, 0.1), least, sizes);
        });
        const auto disagreement = [&](const std::string& name, std::size_t lengths, std::size_t values,
                                      std::size_t slopes, std::size_t worst) {
            wrong(of + "find_disagreement_" + name, [=] {
                const auto jet = Pendulum().jet(kind), end = Pendulum().jet(kind);
                Numbers result(worst);
                jet->find_disagreement(*end, {1, 1, 1}, Numbers(lengths, 0.1), Numbers(values, 0.1),
                                       Numbers(slopes, 0.1), result);
            });
        };
        disagreement("lengths", width + 1, 2 * width, 2 * width, width);
        disagreement("no_lengths", 0, 2 * width, 2 * width, width);
        disagreement("values", width, width, 2 * width, width);
        disagreement("slopes", width, 2 * width, 0, width);
        disagreement("worst", width, 2 * width, 2 * width, 0);
        wrong(of + "find_disagreement_of_another_kind", [kind, width] {
            const LaneKind other = kind == LaneKind::single ? LaneKind::ensemble : LaneKind::single;
            Numbers result(width);
            Pendulum().jet(kind)->find_disagreement(*Pendulum().jet(other), {1, 1, 1}, Numbers(width),
                                                    Numbers(2 * width), Numbers(2 * width), result);
        });
        wrong(of + "find_disagreement_of_another_order", [kind, width] {
            Numbers result(width);
            Pendulum().jet(kind)->find_disagreement(*Pendulum().jet(kind, 5), {1, 1, 1}, Numbers(width),
                                                    Numbers(2 * width), Numbers(2 * width), result);
        });
        wrong(of + "find_disagreement_of_another_tape", [kind, width](Pendulum& other) {
            other.outputs.pop_back();
            Numbers result(width);
            Pendulum().jet(kind)->find_disagreement(*other.jet(kind), {1, 1, 1}, Numbers(width), Numbers(2 * width),
                                                    Numbers(2 * width), result);
        });
    }
    wrong("jet_deferred", wrong_indices(0), [](std::size_t index) { keep(Pendulum().jet()->deferred(index)); });
    wrong("jet_follow_before_it_is_computed", [] {
        constexpr std::uint32_t group = 0;
        make_jet(Pendulum().tape(), 8, LaneKind::single)->compute_deferred({&group, 1});
    });
}

/// Derivatives in two directions along a step of an oscillator with two states.
void tangents(WrongUses& wrong) {
    struct Step {
        System system{oscillator()};
        ModeJets jets = ModeJets(system, 8, LaneKind::single);
        TangentSteps steps = TangentSteps(system, 1e-6, 2);
        std::vector<double> state = std::vector<double>(system.states(), 0.1),
                            matrix = std::vector<double>(2 * system.states(), 1.0), after = matrix;
        Step() {
            const std::vector<double> parameters(system.parameters(), 1.0);
            jets.add_tangents();
            jets.set_parameters(parameters);
            steps.set_parameters(parameters, std::vector<double>(2 * system.parameters(), 0.0));
        }
        void begin() { steps.begin(jets.computed(0, state), 0, state, matrix); }
    };
    wrong("tangent_steps_carry_before_a_step", [](Step& s) { s.steps.carry(s.jets.next(0), 0.1, s.after); });
    wrong("tangent_steps_begin_without_tangents", [](Step& s) {
        ModeJets plain(s.system, 8, LaneKind::single);
        s.steps.begin(plain.computed(0, s.state), 0, s.state, s.matrix);
    });
    wrong("tangent_steps_begin_where_nothing_is_computed",
          [](Step& s) { s.steps.begin(s.jets(0), 0, s.state, s.matrix); });
    wrong("tangent_steps_begin_state", wrong_lengths(3), [](Step& s, std::size_t length) {
        s.steps.begin(s.jets.computed(0, s.state), 0, std::vector<double>(length), s.matrix);
    });
    wrong("tangent_steps_begin_matrix", wrong_lengths(6), [](Step& s, std::size_t length) {
        s.steps.begin(s.jets.computed(0, s.state), 0, s.state, std::vector<double>(length));
    });
    wrong("tangent_steps_parameters", wrong_lengths(5), [](Step& s, std::size_t length) {
        s.steps.set_parameters(std::vector<double>(length), std::vector<double>(10));
    });
    wrong("tangent_steps_directions", wrong_lengths(10), [](Step& s, std::size_t length) {
        s.steps.set_parameters(std::vector<double>(5), std::vector<double>(length));
    });
    wrong("tangent_steps_begin_mode", wrong_indices(1),
          [](Step& s, std::size_t mode) { s.steps.begin(s.jets.computed(0, s.state), mode, s.state, s.matrix); });
    wrong("tangent_steps_carry", wrong_lengths(2), [](Step& s, std::size_t length) {
        s.begin();
        std::vector<double> after(length);
        s.steps.carry(s.jets.next(0), 0.1, after);
    });
}

/// A check of steps of the oscillator.
struct OscillatorCheck {
    StepCheck check{System(oscillator()), 10, 1e-10};
    std::vector<double> coefficients = std::vector<double>(33, 0.1);
    Series series() const { return {coefficients.data(), 1}; }
    /// Asks for the longest step in a mode with so many series.
    void longest(std::size_t mode, std::size_t count, std::span<const double> floors = {}) {
        check.set_parameters(oscillator().parameter_values());
        keep(check.longest(mode, std::vector<Series>(count, series()), 0.1, false, floors));
    }
};

void steps(WrongUses& wrong) {
    for (const double tolerance : {0.0, -1.0, 1.0, not_a_number, infinity}) {
        const std::string number = std::to_string(tolerance);
        wrong("order_for_tolerance_" + number, [tolerance] { keep(order_for_tolerance(tolerance)); });
        wrong("step_size_tolerance_" + number, [tolerance] { keep(StepSize(10, tolerance)); });
        wrong("step_check_tolerance_" + number, [tolerance] { keep(StepCheck(System(oscillator()), 10, tolerance)); });
    }
    for (const int order : {0, -1, highest_order + 1, std::numeric_limits<int>::max()}) {
        wrong("step_size_order_" + std::to_string(order), [order] { keep(StepSize(order, 1e-10)); });
        wrong("step_check_order_" + std::to_string(order),
              [order] { keep(StepCheck(System(oscillator()), order, 1e-10)); });
    }
    wrong("root_finder_degree_negative", [] { keep(RootFinder(-1)); });
    wrong("root_finder_degree_huge", [] { keep(RootFinder(std::numeric_limits<int>::max())); });
    const std::vector<double> cubic = {1, -1, 1, -1};
    wrong("first_falling_degree", [cubic] {
        Root root;
        keep(RootFinder(2).first_falling(cubic, 1, RootStart::as_is, root));
    });
    wrong("crossings_degree", [cubic] {
        std::vector<Root> roots;
        RootFinder(2).crossings(cubic, 1, RootStart::as_is, roots);
    });
    wrong("minimum_degree", [cubic] { keep(RootFinder(2).minimum(cubic, 1)); });
    wrong("step_check_parameters", wrong_lengths(5), [](std::size_t length) {
        StepCheck(System(oscillator()), 10, 1e-10).set_parameters(std::vector<double>(length));
    });
    wrong("step_check_mode", wrong_indices(2), [](OscillatorCheck& c, std::size_t mode) { c.longest(mode, 4); });
    wrong("step_check_series", wrong_lengths(4), [](OscillatorCheck& c, std::size_t length) { c.longest(0, length); });
    for (const std::size_t length : {5, 3})
        wrong(length > 4 ? "step_check_floors_too_long" : "step_check_floors_too_short",
              [length](OscillatorCheck& c) { c.longest(0, 4, std::vector<double>(length)); });
    wrong("step_size_floors", wrong_lengths(2), [](OscillatorCheck& c, std::size_t length) {
        keep(StepSize(10, 1e-10).with_floors(std::vector<Series>(2, c.series()), 0.1, std::vector<double>(length)));
    });
}

void systems(WrongUses& wrong) {
    const auto indices = [&](const std::string& name, std::size_t size,
                             const std::function<void(const System&, std::size_t)>& use) {
        for (const auto& [how, index] : wrong_indices(size))
            wrong("system_" + name + "_" + how, [use, index = index] { use(System(symmetric_oscillator()), index); });
    };
    const Model model = symmetric_oscillator();
    indices("mode", model.modes.size(), [](const System& s, std::size_t i) { keep(s.mode(i)); });
    indices("jump", model.jumps.size(), [](const System& s, std::size_t i) { keep(s.jump(i)); });
    indices("transition", model.transitions.size(), [](const System& s, std::size_t i) { keep(s.transition(i)); });
    indices("symmetry", model.symmetries.size(), [](const System& s, std::size_t i) { keep(s.symmetry(i)); });
    indices("event", model.events.size(), [](const System& s, std::size_t i) { keep(s.event(i)); });
    indices("section", model.sections.size(), [](const System& s, std::size_t i) { keep(s.section(i)); });
    indices("section_of_symmetry", model.symmetries.size(),
            [](const System& s, std::size_t i) { keep(s.section(0, i)); });
    const auto expressions = [&](const std::string& kind, const Expression& expression) {
        const std::vector<Expression> list = {expression};
        wrong("system_observing_" + kind, [list] { keep(System(oscillator()).observing(list)); });
        wrong("system_function_of_" + kind, [list] { keep(System(oscillator()).function_of(list)); });
        wrong("system_parameter_function_" + kind, [list] { keep(System(oscillator()).function_of_parameters(list)); });
        wrong("system_gradient_" + kind, [list] { keep(System(oscillator()).with_gradient(list[0])); });
    };
    expressions("nothing", {});
    expressions("unknown", Graph::create()->symbol("unknown"));
    wrong("system_parameter_function_of_state",
          [] { keep(System(oscillator()).function_of_parameters(std::vector{Graph::create()->symbol("x")})); });
    wrong("system_model_grows", [] { keep(System(oscillator()).model().symbol("new")); });
    wrong("moved_system", [] {
        System system(oscillator());
        const System moved = std::move(system);
        keep(system.model().name);
    });
}

void mode_flows(WrongUses& wrong) {
    const std::size_t n = oscillator().states.size(), parameters = oscillator().parameter_values().size();
    const auto made = [] {
        ModeFlow flow(System(oscillator()), 1e-10, 0, {ParameterId(0)});
        flow.set_parameters(oscillator().parameter_values());
        return flow;
    };
    for (const double tolerance : {0.0, -1.0, not_a_number})
        wrong("mode_flow_tolerance_" + std::to_string(tolerance),
              [tolerance] { keep(ModeFlow(System(oscillator()), tolerance)); });
    for (const int order : {3, -1, highest_order + 1})
        wrong("mode_flow_order_" + std::to_string(order),
              [order] { keep(ModeFlow(System(oscillator()), 1e-10, order)); });
    wrong("mode_flow_free", wrong_indices(parameters),
          [](std::size_t index) { keep(ModeFlow(System(oscillator()), 1e-10, 0, {ParameterId(index)})); });
    wrong("mode_flow_start", wrong_indices(n),
          [](std::size_t index) { keep(ModeFlow(System(oscillator()), 1e-10, 0, {}, std::vector{index})); });
    wrong("mode_flow_run", wrong_indices(oscillator().modes.size()), [made, n](std::size_t index) {
        std::vector<double> state(n, 0.1);
        keep(made().run(index, state, 0.1));
    });
    wrong("mode_flow_parameters", wrong_lengths(parameters),
          [made](std::size_t length) { made().set_parameters(std::vector<double>(length)); });
    wrong("mode_flow_state", wrong_lengths(n), [made](std::size_t length) {
        std::vector<double> state(length, 0.1);
        keep(made().run(0, state, 0.1));
    });
    wrong("mode_flow_derivatives", wrong_lengths(n * (n + 1)), [made, n](std::size_t length) {
        std::vector<double> state(n, 0.1), derivatives(length);
        keep(made().run(0, state, 0.1, derivatives));
    });
    wrong("mode_flow_before_parameters", [n] {
        ModeFlow flow(System(oscillator()), 1e-10);
        std::vector<double> state(n, 0.1);
        keep(flow.run(0, state, 0.1));
    });
}

/// Valid arguments for the oscillator with one free parameter, of which tests spoil one each.
struct SecondOrderRun {
    VariationalSystem system{System(oscillator()), {ParameterId(0)}};
    SecondOrderFlow flow{system, 1e-10};
    std::size_t mode = 0;
    std::vector<double> parameters = oscillator().parameter_values(), state = oscillator().initial_state(),
                        vector = std::vector<double>(state.size() + 1, 0.5),
                        derivatives = std::vector<double>(state.size() * vector.size()), second = derivatives;
    void run() {
        flow.set_parameters(parameters);
        keep(flow.run(mode, state, 0.1, vector, derivatives, second));
    }
};

void second_order_flows(WrongUses& wrong) {
    const SecondOrderRun right;
    for (const double tolerance : {0.0, -1.0, not_a_number})
        wrong("second_order_tolerance_" + std::to_string(tolerance),
              [tolerance] { keep(SecondOrderFlow(SecondOrderRun().system, tolerance)); });
    for (const int order : {3, -1, highest_order + 1})
        wrong("second_order_order_" + std::to_string(order),
              [order] { keep(SecondOrderFlow(SecondOrderRun().system, 1e-10, order)); });
    const auto run =
        wrong.spoiled<SecondOrderRun>([] { return SecondOrderRun(); }, {{"second_order", &SecondOrderRun::run}});
    using Numbers = std::vector<double> SecondOrderRun::*;
    for (const auto& [name, numbers] : {std::pair<std::string, Numbers>("parameters", &SecondOrderRun::parameters),
                                        {"state", &SecondOrderRun::state},
                                        {"vector", &SecondOrderRun::vector},
                                        {"first", &SecondOrderRun::derivatives},
                                        {"second", &SecondOrderRun::second}})
        for (const auto& [how, length] : wrong_lengths((right.*numbers).size()))
            run(name + "_" + how,
                [numbers = numbers, length = length](SecondOrderRun& r) { (r.*numbers).resize(length); });
    run("run", wrong_indices(oscillator().modes.size()), [](SecondOrderRun& r, std::size_t index) { r.mode = index; });
    for (const double component : {not_a_number, infinity})
        run("vector_" + std::to_string(component), [component](SecondOrderRun& r) { r.vector[1] = component; });
    wrong("second_order_before_parameters",
          [](SecondOrderRun& r) { keep(r.flow.run(0, r.state, 0.1, r.vector, r.derivatives, r.second)); });

    wrong("variational_free", wrong_indices(oscillator().parameter_values().size()),
          [](std::size_t index) { keep(VariationalSystem(System(oscillator()), {ParameterId(index)})); });
    wrong("variational_free_twice", [] {
        keep(VariationalSystem(System(oscillator()), {ParameterId(1), ParameterId(0), ParameterId(1)}));
    });
    const auto indices = [&](const std::string& name, std::size_t size,
                             const std::function<void(const VariationalSystem&, std::size_t)>& use) {
        for (const auto& [how, index] : wrong_indices(size))
            wrong("variational_" + name + "_" + how,
                  [use, index = index] { use(VariationalSystem(System(symmetric_oscillator())), index); });
    };
    const Model model = symmetric_oscillator();
    indices("jump", model.jumps.size(), [](const VariationalSystem& s, std::size_t i) { keep(s.jump(i)); });
    indices("symmetry", model.symmetries.size(),
            [](const VariationalSystem& s, std::size_t i) { keep(s.symmetry(i)); });
    indices("event", model.events.size(), [](const VariationalSystem& s, std::size_t i) { keep(s.event(i)); });
    indices("section", model.sections.size(), [](const VariationalSystem& s, std::size_t i) { keep(s.section(i)); });
    indices("section_of_symmetry", model.symmetries.size(),
            [](const VariationalSystem& s, std::size_t i) { keep(s.section(0, i)); });
    const auto function = [&](const std::string& kind, const Expression& expression) {
        wrong("variational_function_of_" + kind,
              [expression] { keep(VariationalSystem(System(oscillator())).function_of(std::vector{expression})); });
    };
    function("nothing", {});
    function("unknown", Graph::create()->symbol("unknown"));
    wrong("moved_variational_system", [] {
        VariationalSystem system{System(oscillator())};
        const VariationalSystem moved = std::move(system);
        keep(system.variables());
    });
}

TEST(WrongFlowUse, IsRefused) {
    expect_refusals({tapes, wrong_jets, tangents, steps, systems, mode_flows, second_order_flows});
}

} // namespace graze::flow_misuse_test
