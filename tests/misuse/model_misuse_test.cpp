// Invalid models, which every function that takes a model refuses; and requests for parts that a model does not have.

#include "misuse/valid_objects.hpp"
#include "misuse/wrong_use.hpp"

#include "graze/model/check.hpp"
#include "graze/model/microbeam.hpp"
#include "graze/model/named_value.hpp"

namespace graze::model_misuse_test {

using namespace graze::testing;

void defective_models(WrongUses& wrong) {
    const auto model =
        wrong.spoiled<Model>(oscillator, {{"validate", [](Model& m) { m.validate(); }},
                                          {"system", [](Model& m) { keep(System(m)); }},
                                          {"write_model", [](Model& m) { keep(write_model(m)); }},
                                          {"write_equations", [](Model& m) { keep(write_equations(m)); }},
                                          {"model_warnings", [](Model& m) { keep(model_warnings(m)); }},
                                          {"connectivity_graph", [](Model& m) { keep(connectivity_graph(m)); }}});
    model("no_graph", [](Model& m) { m.graph = nullptr; });
    model("no_states", [](Model& m) { m.states.clear(); });
    model("no_modes", [](Model& m) { m.modes.clear(); });
    model("no_jumps", [](Model& m) { m.jumps.clear(); });
    model("no_events", [](Model& m) { m.events.clear(); });
    model("no_parameters", [](Model& m) { m.parameters.clear(); });
    model("initial_nothing", [](Model& m) { m.states[0].initial = {}; });
    model("initial_in_states", [](Model& m) { m.states[0].initial = m.symbol("v"); });
    model("initial_undefined", [](Model& m) { m.states[0].initial = m.number(1) / m.number(0); });
    model("period_nothing", [](Model& m) { m.states[0].period = Expression(); });
    model("period_zero", [](Model& m) { m.states[2].period = m.number(0); });
    model("period_negative", [](Model& m) { m.states[2].period = m.number(-1); });
    model("period_in_states", [](Model& m) { m.states[2].period = m.symbol("x"); });
    model("state_without_name", [](Model& m) { m.states[0].name = ""; });
    model("state_named_twice", [](Model& m) { m.states[0].name = "v"; });
    model("state_named_as_parameter", [](Model& m) { m.states[0].name = "zeta"; });
    model("state_named_pi", [](Model& m) { m.states[0].name = "pi"; });
    model("state_more_than_rates", [](Model& m) { m.states.push_back({.name = "w", .initial = m.number(0)}); });
    model("parameter_without_value", [](Model& m) { m.parameters[0].value.reset(); });
    model("parameter_with_both", [](Model& m) { m.parameters[0].expression = m.number(1); });
    model("parameter_nan", [](Model& m) { m.parameters[0].value = not_a_number; });
    model("parameter_infinite", [](Model& m) { m.parameters[0].value = infinity; });
    model("parameter_named_twice", [](Model& m) { m.parameters[0].name = "omega"; });
    model("parameter_nothing", [](Model& m) {
        m.parameters[0].value.reset();
        m.parameters[0].expression = Expression();
    });
    model("parameter_in_states", [](Model& m) {
        m.parameters[0].value.reset();
        m.parameters[0].expression = m.symbol("x");
    });
    model("parameter_of_itself", [](Model& m) {
        m.parameters[0].value.reset();
        m.parameters[0].expression = m.symbol("zeta") + 1;
    });
    model("definition_nothing", [](Model& m) { m.definitions[0].value = {}; });
    model("definition_of_itself", [](Model& m) { m.definitions[0].value = m.symbol("force") + 1; });
    model("definition_unknown", [](Model& m) { m.definitions[0].value = m.symbol("unknown"); });
    model("definition_no_such_node", [](Model& m) { m.definitions[0].value = Expression(m.graph, 1'000'000); });
    model("definition_of_another_graph", [](Model& m) { m.definitions[0].value = Graph::create()->symbol("unknown"); });
    model("mode_without_name", [](Model& m) { m.modes[0].name = ""; });
    model("mode_named_twice", [](Model& m) { m.modes[0].name = "stuck"; });
    model("rates_none", [](Model& m) { m.modes[0].rates.clear(); });
    model("rates_too_few", [](Model& m) { m.modes[0].rates.pop_back(); });
    model("rates_too_many", [](Model& m) { m.modes[0].rates.push_back(m.number(0)); });
    model("rate_nothing", [](Model& m) { m.modes[0].rates[1] = {}; });
    model("rate_unknown", [](Model& m) { m.modes[0].rates[1] = m.symbol("unknown"); });
    model("rate_no_such_node", [](Model& m) { m.modes[0].rates[1] = Expression(m.graph, 1'000'000); });
    model("watched_twice", [](Model& m) { m.modes[0].watched = {0, 0}; });
    model("event_nothing", [](Model& m) { m.events[0].function = {}; });
    model("event_without_name", [](Model& m) { m.events[0].name = ""; });
    model("event_unknown", [](Model& m) { m.events[0].function = m.symbol("unknown"); });
    model("event_of_no_kind", [](Model& m) { m.events[0].kind = static_cast<EventKind>(77); });
    model("jump_0_no_identity", [](Model& m) { m.jumps[0].map = {m.number(0), m.number(0), m.number(0)}; });
    model("jump_map_empty", [](Model& m) { m.jumps[1].map.clear(); });
    model("jump_map_too_short", [](Model& m) { m.jumps[1].map.pop_back(); });
    model("jump_map_too_long", [](Model& m) { m.jumps[1].map.push_back(m.number(0)); });
    model("jump_map_nothing", [](Model& m) { m.jumps[1].map[0] = {}; });
    model("transition_without_next", [](Model& m) { m.transitions[0].next.clear(); });
    model("transition_twice", [](Model& m) { m.transitions.push_back(m.transitions[0]); });
    model("transition_missing", [](Model& m) { m.transitions.clear(); });
    model("transition_label_empty", [](Model& m) { m.transitions[0].label = ""; });
    model("condition_nothing", [](Model& m) { m.transitions[0].next[0].when[0].function = {}; });
    model("condition_unknown", [](Model& m) { m.transitions[0].next[0].when[0].function = m.symbol("unknown"); });
    model("section_of_nothing", [](Model& m) { m.sections[1].function = {}; });
    model("section_of_both", [](Model& m) { m.sections[1].state = 2; });
    model("section_value_nothing", [](Model& m) { m.sections[0].value = {}; });
    model("section_value_in_states", [](Model& m) { m.sections[0].value = m.symbol("x"); });
    model("section_state_not_cyclic", [](Model& m) { m.sections[0].state = 0; });
    model("section_in_no_direction", [](Model& m) { m.sections[1].direction = static_cast<Direction>(77); });
    model("section_without_name", [](Model& m) { m.sections[0].name = ""; });
    model("symmetry_map_empty", [](Model& m) { m.symmetries = {{.name = "s", .modes = {0, 1}}}; });
    model("symmetry_modes_empty", [](Model& m) { m.symmetries = {{.name = "s", .map = m.state_symbols()}}; });
    model("symmetry_map_nothing", [](Model& m) {
        m.symmetries = {{.name = "s", .map = std::vector<Expression>(3), .modes = {0, 1}}};
    });
    model("symmetry_modes_twice", [](Model& m) {
        m.symmetries = {{.name = "s", .map = m.state_symbols(), .modes = {0, 0}}};
    });
    model("quantity_nothing", [](Model& m) { m.quantities[0].value = {}; });
    model("quantity_unknown", [](Model& m) { m.quantities[0].value = m.symbol("unknown"); });
    model("all_of_moved_model", [](Model& m) { const Model moved = std::move(m); });
    model("watched", wrong_indices(2), [](Model& m, std::size_t i) { m.modes[0].watched = {i}; });
    model("transition_mode", wrong_indices(2), [](Model& m, std::size_t i) { m.transitions[0].mode = i; });
    model("transition_event", wrong_indices(2), [](Model& m, std::size_t i) { m.transitions[0].event = i; });
    model("transition_jump", wrong_indices(2),
          [](Model& m, std::size_t i) { m.transitions[0].jump = i < 4 ? i + 1 : i; });
    model("next_mode", wrong_indices(2), [](Model& m, std::size_t i) { m.transitions[0].next[0].mode = i; });
    model("chatter_mode", wrong_indices(2), [](Model& m, std::size_t i) { m.transitions[0].chatter = Sticking{2, i}; });
    model("chatter_jump", wrong_indices(2), [](Model& m, std::size_t i) {
        m.transitions[0].chatter = Sticking{i < 4 ? i + 1 : i, 1};
    });
    model("section_state", wrong_indices(2), [](Model& m, std::size_t i) { m.sections[0].state = i < 4 ? i + 1 : i; });
    model("symmetry_mode", wrong_indices(2), [](Model& m, std::size_t i) {
        m.symmetries = {{.name = "s", .map = m.state_symbols(), .modes = {0, i}}};
    });
    model("initial_mode", wrong_indices(2), [](Model& m, std::size_t i) { m.initial_mode = i; });
}

void moved_models(WrongUses& wrong) {
    const auto with = [&](const std::string& name, const std::function<void(Model&)>& use) {
        wrong("moved_model_" + name, [use] {
            Model model = oscillator();
            const Model moved = std::move(model);
            use(model);
        });
    };
    with("number", [](Model& model) { keep(model.number(1)); });
    with("symbol", [](Model& model) { keep(model.symbol("x")); });
    with("freeze", [](Model& model) { model.freeze(); });
    with("expand", [](Model& model) { keep(model.expand(Graph::create()->symbol("x"))); });
}

void questions(WrongUses& wrong) {
    const auto ask = [&](const std::string& name, const std::function<void(Model&)>& use) {
        wrong(name, [use] {
            Model model = oscillator();
            use(model);
        });
    };
    for (const std::string name : {"", "unknown", "x", "force"}) {
        ask("set_parameter_" + name, [name](Model& m) { m.set_parameter(name, 1); });
        ask("independent_parameter_" + name, [name](Model& m) { keep(m.independent_parameter(name)); });
        ask("section_probe_" + name, [name](Model& m) { keep(section_probe(m, name)); });
        ask("set_initial_mode_" + name, [name](Model& m) { m.set_initial_mode(name); });
    }
    for (const std::string name : {"", "unknown", "zeta", "force"})
        ask("set_initial_" + name, [name](Model& m) { m.set_initial(name, 1); });
    for (const auto& [kind, value] : not_finite()) {
        ask("set_parameter_" + kind, [value = value](Model& m) { m.set_parameter("zeta", value); });
        ask("set_initial_" + kind, [value = value](Model& m) { m.set_initial("x", value); });
        ask("model_number_" + kind, [value = value](Model& m) { keep(m.number(value)); });
    }
    const auto dependent = [](Model& m) {
        m.parameters.push_back({.name = "twice", .expression = m.symbol("zeta") * 2.0});
    };
    ask("set_dependent_parameter", [dependent](Model& m) {
        dependent(m);
        m.set_parameter("twice", 1);
    });
    ask("place_of_dependent_parameter", [dependent](Model& m) {
        dependent(m);
        keep(m.independent_parameter("twice"));
    });
    ask("expand_nothing", [](Model& m) { keep(m.expand(Expression())); });
    ask("expand_list_of_nothing", [](Model& m) { keep(m.expand(std::vector<Expression>(2))); });
    ask("expand_circle", [](Model& m) {
        m.definitions[0].value = m.symbol("force") + 1;
        keep(m.expand(m.symbol("force")));
    });
    ask("expand_definition_of_nothing", [](Model& m) {
        m.definitions[0].value = {};
        keep(m.expand(m.symbol("force")));
    });
    ask("function_of_nothing", [](Model& m) { keep(m.function_of(std::vector<Expression>(1))); });
    ask("function_of_unknown", [](Model& m) { keep(m.function_of(std::vector{m.symbol("unknown")})); });
    ask("values_of_nothing", [](Model& m) { keep(m.values_of(std::vector<Expression>(1))); });
    ask("values_of_state", [](Model& m) { keep(m.values_of(std::vector{m.symbol("x")})); });
    ask("values_of_unknown", [](Model& m) { keep(m.values_of(std::vector{m.symbol("unknown")})); });
    ask("require_known_unknown", [](Model& m) { m.require_known(m.inputs(), std::vector{m.symbol("unknown")}); });
    ask("require_known_nothing", [](Model& m) { m.require_known(m.inputs(), std::vector<Expression>(1)); });
    ask("require_known_inputs_of_nothing",
        [](Model& m) { m.require_known(std::vector<Expression>(1), std::vector{m.symbol("x")}); });
    ask("initial_state_infinite", [](Model& m) {
        m.states[0].initial = m.number(1) / (m.symbol("zeta") - m.symbol("zeta") * 1.0);
        keep(m.initial_state());
    });
    ask("initial_state_nothing", [](Model& m) {
        m.states[0].initial = {};
        keep(m.initial_state());
    });
    ask("periods_nothing", [](Model& m) {
        m.states[0].period = Expression();
        keep(m.periods());
    });
    ask("parameter_values_missing", [](Model& m) {
        m.parameters[0].value.reset();
        keep(m.parameter_values());
    });
    ask("frozen_model_new_symbol", [](Model& m) {
        m.freeze();
        keep(m.symbol("new"));
    });
    for (const std::string text : {"", "x +", "unknown", "1/(x", "x > 0"})
        ask("named_value_" + text, [text](Model& m) { keep(named_value(m, text, {})); });
    for (const std::string text : {"", "x", "unknown", "1/0", "log(-1)", "1e999"})
        ask("value_of_text_" + text, [text](Model& m) { keep(value_of_text(m, text, {})); });
}

void files(WrongUses& wrong) {
    for (const std::string name : {"", "unknown", "impact-oscilator", "/no/such.toml", "/tmp/", "../x"})
        wrong("load_model_" + name, [name] { keep(load_model(name)); });
    for (const std::string path : {"", "/no/such/file.toml", "/tmp"})
        wrong("read_model_" + path, [path] { keep(read_model(path)); });
    for (const std::string text :
         {"", "garbage", "name = 'a'", "[states]", "name = 1", "\xff", "[", "name = 'a'\n[states]\nx = {}"})
        wrong("parse_model_" + text, [text] { keep(parse_model(text, "file.toml")); });
}

void microbeams(WrongUses& wrong) {
    for (const int count : {0, -1, std::numeric_limits<int>::min()}) {
        wrong("beam_modes_" + std::to_string(count), [count] { keep(ClampedBeamModes(count)); });
        wrong("microbeam_modes_" + std::to_string(count), [count] { keep(microbeam({.modes = count})); });
        wrong("microbeam_points_" + std::to_string(count), [count] { keep(microbeam({.points = count})); });
    }
    wrong("microbeam_points_odd", [] { keep(microbeam({.points = 7})); });
    wrong("microbeam_no_quadrature", [] { keep(microbeam({.quadrature = static_cast<Quadrature>(9)})); });
    for (const int i : {0, -1, 4, std::numeric_limits<int>::max()}) {
        const std::string number = std::to_string(i);
        wrong("beam_frequency_" + number, [i] { keep(ClampedBeamModes(3).frequency(i)); });
        wrong("beam_shape_" + number, [i] { keep(ClampedBeamModes(3).shape(i, 0.5)); });
        wrong("beam_slope_" + number, [i] { keep(ClampedBeamModes(3).slope(i, 0.5)); });
        wrong("beam_product_left_" + number, [i] { keep(ClampedBeamModes(3).slope_product(i, 1)); });
        wrong("beam_product_right_" + number, [i] { keep(ClampedBeamModes(3).slope_product(1, i)); });
    }
    for (const double x : {-0.1, 1.1, not_a_number, infinity}) {
        wrong("beam_shape_at_" + std::to_string(x), [x] { keep(ClampedBeamModes(3).shape(1, x)); });
        wrong("beam_slope_at_" + std::to_string(x), [x] { keep(ClampedBeamModes(3).slope(1, x)); });
    }
    const std::vector<std::pair<std::string, double MicrobeamOptions::*>> members = {
        {"gamma", &MicrobeamOptions::gamma},
        {"thickness", &MicrobeamOptions::thickness},
        {"width", &MicrobeamOptions::width},
        {"gap", &MicrobeamOptions::gap},
        {"stop_position", &MicrobeamOptions::stop_position},
        {"stop_distance", &MicrobeamOptions::stop_distance},
        {"stop_stiffness", &MicrobeamOptions::stop_stiffness},
        {"frequency", &MicrobeamOptions::frequency},
        {"voltage", &MicrobeamOptions::voltage},
        {"damping", &MicrobeamOptions::damping}};
    for (const auto& [name, member] : members)
        for (const auto& [kind, value] : not_finite())
            wrong("microbeam_" + name + "_" + kind, [member = member, value = value] {
                MicrobeamOptions options;
                options.*member = value;
                keep(microbeam(options));
            });
}

TEST(WrongModelUse, IsRefused) {
    expect_refusals({defective_models, moved_models, questions, files, microbeams});
}

} // namespace graze::model_misuse_test
