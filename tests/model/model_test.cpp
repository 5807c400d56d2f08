#include "graze/model/model.hpp"

#include "base/message_of.hpp"
#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace graze::model_test {

using testing::message_of;

/// A bouncing ball, built from C++.
Model ball() {
    Model model;
    model.name = "ball";
    model.parameters.push_back({"g", "m/s^2", "", 9.81, {}});
    model.parameters.push_back({"e", "", "", 0.5, {}});
    model.parameters.push_back({"twice", "", "", {}, 2 * model.symbol("g")});
    model.states.push_back({"x", "m", "", model.graph->number(1), {}, false});
    model.states.push_back({"v", "m/s", "", model.graph->number(0), {}, false});
    const Expression x = model.symbol("x"), v = model.symbol("v");
    model.definitions.push_back({"weight", "", -model.symbol("g")});
    model.events.push_back({"contact", "", x, EventKind::barrier});
    model.jumps.push_back({"impact", "", {x, -model.symbol("e") * v}});
    model.modes.push_back({"flight", "", {v, model.symbol("weight")}, {0}});
    model.transitions.push_back({"J1", 0, 0, 1, {{{}, "", 0}}, {}});
    model.quantities.push_back({"energy", "J/kg", "", pow(v, 2) / 2 + model.symbol("g") * x});
    return model;
}

/// Checks that a change makes the model invalid, and the message.
void expect_invalid(const std::function<void(Model&)>& change, const std::string& words) {
    Model model = ball();
    EXPECT_NO_THROW(model.validate());
    change(model);
    try {
        model.validate();
        ADD_FAILURE() << "accepted; expected: " << words;
    } catch (const InputError& error) {
        EXPECT_NE(error.problem().find(words), std::string::npos) << error.what();
        EXPECT_FALSE(error.remedy().empty()) << error.what();
        EXPECT_EQ(error.place().file, "ball") << error.what();
    }
}

TEST(Model, FindsItemsByName) {
    const Model model = ball();
    EXPECT_EQ(model.find_parameter("e"), 1U);
    EXPECT_EQ(model.find_state("v"), 1U);
    EXPECT_EQ(model.find_mode("flight"), 0U);
    EXPECT_EQ(model.find_event("contact"), 0U);
    EXPECT_EQ(model.find_jump("identity"), 0U);
    EXPECT_EQ(model.find_jump("impact"), 1U);
    EXPECT_EQ(model.find_quantity("energy"), 0U);
    EXPECT_FALSE(model.find_section("contact"));
    EXPECT_FALSE(model.find_state("g"));
    EXPECT_EQ(model.find_transition(0, 0), &model.transitions[0]);
    EXPECT_EQ(model.find_transition(0, 1), nullptr);
}

TEST(Model, TellsUnitsOfParameters) {
    Model model = ball();
    model.parameters[2].unit = "km/s^2";
    EXPECT_EQ(model.parameter_unit("g"), "m/s^2");
    EXPECT_EQ(model.parameter_unit("e"), "");
    EXPECT_EQ(model.parameter_unit("twice"), "km/s^2"); // of a dependent parameter too
    EXPECT_EQ(model.parameter_unit("x"), "");           // a state
    EXPECT_EQ(model.parameter_unit("none"), "");
}

TEST(Model, ListsIndependentParametersOnly) {
    const Model model = ball();
    EXPECT_EQ(model.parameter_symbols(), (std::vector<Expression>{model.symbol("g"), model.symbol("e")}));
    EXPECT_EQ(model.parameter_values(), (std::vector<double>{9.81, 0.5}));
    EXPECT_EQ(model.state_symbols(), (std::vector<Expression>{model.symbol("x"), model.symbol("v")}));
}

TEST(Model, ExpandsDefinitionsThroughEachOther) {
    Model model = ball();
    const Expression x = model.symbol("x");
    model.definitions.push_back({"last", "", model.symbol("middle") + model.symbol("twice")});
    model.definitions.push_back({"middle", "", sin(model.symbol("first")) * model.symbol("first")});
    model.definitions.push_back({"first", "", x / model.symbol("weight")});
    const Expression g = model.symbol("g");
    const Expression first = x / -g;
    EXPECT_EQ(model.expand(model.symbol("last")), sin(first) * first + 2 * g);
    EXPECT_EQ(model.expand(x), x);
    EXPECT_TRUE(model.expand(std::vector<Expression>{}).empty());
}

TEST(Model, ExpandsLongChainsOfDefinitions) {
    Model model = ball();
    constexpr int length = 20000;
    for (int i = 0; i < length; ++i) {
        const Expression next = i + 1 < length ? model.symbol("d" + std::to_string(i + 1)) : model.symbol("x");
        model.definitions.push_back({"d" + std::to_string(i), "", next * 0.5 + 1});
    }
    model.validate();
    const Expression expanded = model.expand(model.symbol("d0"));
    const Function function(model.state_symbols(), std::vector<Expression>{expanded});
    EXPECT_EQ(function(std::vector<double>{1.0, 0.0})[0], 2.0);
    model.definitions.back().value = model.symbol("d0");
    EXPECT_THROW(model.validate(), InputError);
    EXPECT_THROW(model.expand(model.symbol("d0")), InputError);
}

TEST(Model, ExpandsManyDefinitionsOfALargeGraph) {
    Model model = ball();
    Expression term = model.symbol("x");
    for (int i = 0; i < 300; ++i) {
        for (int k = 0; k < 200; ++k)
            term = sin(term) + model.symbol("v");
        model.definitions.push_back({"d" + std::to_string(i), "", term});
    }
    for (int i = 0; i < 300; ++i)
        model.quantities.push_back({"q" + std::to_string(i), "", "", model.symbol("d" + std::to_string(i))});
    model.validate();
    EXPECT_EQ(model.expand(model.symbol("d299")), term);
}

TEST(Model, ExpandShowsTheCircle) {
    Model model = ball();
    model.definitions.push_back({"a", "", model.symbol("b") + 1});
    model.definitions.push_back({"b", "", model.symbol("c") * 2});
    model.definitions.push_back({"c", "", model.symbol("b")});
    EXPECT_NE(message_of([&] { model.expand(model.symbol("a")); }).find("b -> c -> b"), std::string::npos);
    EXPECT_NO_THROW(model.expand(model.symbol("weight")));
}

TEST(Model, SetsParametersAndInitialValues) {
    Model model = ball();
    model.set_parameter("g", 1.62);
    EXPECT_EQ(model.parameter_values()[0], 1.62);
    model.set_initial("v", -2);
    EXPECT_EQ(model.initial_state(), (std::vector<double>{1, -2}));
    model.states[0].initial = model.symbol("twice") / 2;
    EXPECT_EQ(model.initial_state()[0], 1.62);
    model.set_initial_mode("flight");
    EXPECT_EQ(model.initial_mode, 0U);

    EXPECT_NE(message_of([&] { model.set_parameter("gg", 1); }).find("no parameter 'gg'; did you mean 'g'?"),
              std::string::npos);
    EXPECT_NE(message_of([&] { model.set_parameter("twice", 1); }).find("follows from others"), std::string::npos);
    EXPECT_NE(message_of([&] { model.set_parameter("g", std::nan("")); }).find("finite"), std::string::npos);
    EXPECT_NE(message_of([&] { model.set_initial("y", 1); }).find("no state 'y'"), std::string::npos);
    EXPECT_NE(message_of([&] { model.set_initial("x", INFINITY); }).find("finite"), std::string::npos);
    EXPECT_NE(message_of([&] { model.set_initial_mode("fligth"); }).find("'flight'"), std::string::npos);
    EXPECT_EQ(model.parameter_values()[0], 1.62);
}

TEST(Model, KeepsInitialCyclicStatesWithinTheirPeriod) {
    Model model = ball();
    model.parameters.push_back({"turn", "", "", 2.0, {}});
    model.states[0].period = model.symbol("turn");
    const auto initial = [&](double value) {
        model.set_initial("x", value);
        return model.initial_state()[0];
    };
    EXPECT_EQ(initial(0), 0);
    EXPECT_EQ(initial(1.5), 1.5);
    EXPECT_EQ(initial(2), 0);
    EXPECT_EQ(initial(-0.5), 1.5);
    EXPECT_EQ(initial(1001), 1);
    EXPECT_EQ(initial(-std::numeric_limits<double>::denorm_min()), 0);
    model.set_parameter("turn", -1);
    EXPECT_NE(message_of([&] { model.initial_state(); }).find("the period of 'x' is -1"), std::string::npos);
}

TEST(Model, RefusesInitialValuesThatAreNotFinite) {
    Model model = ball();
    model.states[1].initial = 1 / (model.symbol("e") - 0.25);
    EXPECT_EQ(model.initial_state()[1], 4);
    model.set_parameter("e", 0.25);
    EXPECT_NE(message_of([&] { model.initial_state(); }).find("the initial value of 'v' is inf"), std::string::npos);
}

TEST(Model, ValidatesNames) {
    expect_invalid([](Model& m) { m.parameters[0].name = "sin"; }, "'sin' is a reserved name");
    expect_invalid([](Model& m) { m.parameters[0].name = "1g"; }, "'1g' cannot be the name of a parameter");
    expect_invalid([](Model& m) { m.parameters[0].name = "e"; }, "the name 'e' is used twice");
    expect_invalid([](Model& m) { m.modes[0].name = ""; }, "'' cannot be the name of a mode");
    expect_invalid([](Model& m) { m.events.push_back(m.events[0]); }, "there are two events 'contact'");
    expect_invalid([](Model& m) { m.jumps.erase(m.jumps.begin()); }, "the first jump is not the identity");
    expect_invalid([](Model& m) { m.quantities.push_back(m.quantities[0]); }, "'energy' of a quantity is used twice");
}

TEST(Model, ValidatesSizesAndIndices) {
    expect_invalid([](Model& m) { m.states.clear(); }, "no states");
    expect_invalid([](Model& m) { m.modes.clear(); }, "no modes");
    expect_invalid([](Model& m) { m.modes[0].rates.pop_back(); }, "modes.flight.rates has 1 entries for 2 states");
    expect_invalid([](Model& m) { m.jumps[1].map.clear(); }, "jumps.impact has 0 entries for 2 states");
    expect_invalid([](Model& m) { m.jumps[0].map = m.jumps[1].map; }, "'identity' changes states");
    expect_invalid([](Model& m) { m.initial_mode = 1; }, "initial.mode refers to mode 1");
    expect_invalid([](Model& m) { m.modes[0].watched[0] = 3; }, "modes.flight.watch refers to event 3");
    expect_invalid([](Model& m) { m.transitions[0].jump = 2; }, "transitions.1.jump refers to jump 2");
    expect_invalid([](Model& m) { m.transitions[0].next[0].mode = 9; }, "transitions.1.next refers to mode 9");
    expect_invalid(
        [](Model& m) {
            m.transitions[0].chatter = Sticking{0, 4};
        },
        "transitions.1.chatter.mode refers to mode 4");
    expect_invalid([](Model& m) { m.transitions[0].next.clear(); }, "does not say what comes next");
    expect_invalid(
        [](Model& m) {
            m.symmetries.push_back({"s", "", m.state_symbols(), {}});
        },
        "symmetries.s.modes has 0 entries for 1 modes");
    expect_invalid(
        [](Model& m) {
            m.sections.push_back({"s", "", {}, 2, m.graph->number(0), {}});
        },
        "sections.s.state refers to state 2");
}

TEST(Model, ValidatesExpressions) {
    expect_invalid([](Model& m) { m.modes[0].rates[0] = Expression(); }, "modes.flight.rates.x is missing");
    expect_invalid([](Model& m) { m.modes[0].rates[0] = Graph::create()->symbol("v"); }, "another graph");
    expect_invalid([](Model& m) { m.modes[0].rates[0] = m.symbol("w"); },
                   "modes.flight.rates.x uses the unknown name 'w'");
    expect_invalid([](Model& m) { m.states[0].initial = m.symbol("v"); }, "states.x.initial uses the state 'v'");
    expect_invalid([](Model& m) { m.parameters[2].expression = m.symbol("weight"); }, "uses the definition 'weight'");
    expect_invalid([](Model& m) { m.parameters[2].expression = m.symbol("twice"); }, "twice -> twice");
    expect_invalid(
        [](Model& m) {
            m.transitions[0].next[0].when.push_back({m.symbol("y"), true});
        },
        "transitions.1.next.1.when uses the unknown name 'y'");
}

TEST(Model, ValidatesValuesAndTransitions) {
    expect_invalid([](Model& m) { m.parameters[0].value = std::nan(""); }, "the value of parameter 'g' is nan");
    expect_invalid([](Model& m) { m.parameters[0].value.reset(); }, "either a value or an expression");
    expect_invalid([](Model& m) { m.parameters[2].value = 1; }, "either a value or an expression");
    expect_invalid([](Model& m) { m.parameters[2].expression = log(-m.symbol("g")); }, "parameters.twice.value is");
    expect_invalid([](Model& m) { m.states[0].period = m.graph->number(0); }, "the period of 'x' is 0");
    expect_invalid([](Model& m) { m.transitions.push_back(m.transitions[0]); },
                   "a second transition for event 'contact'");
    expect_invalid([](Model& m) { m.transitions.clear(); }, "watches the barrier 'contact' but has no transition");
    expect_invalid([](Model& m) { m.modes[0].watched.push_back(0); }, "watches event 'contact' twice");
    expect_invalid(
        [](Model& m) {
            m.sections.push_back({"s", "", {}, 0, m.graph->number(0), {}});
        },
        "which is not cyclic");
    // A section may be watched without a transition.
    Model model = ball();
    model.events[0].kind = EventKind::section;
    model.transitions.clear();
    EXPECT_NO_THROW(model.validate());
}

} // namespace graze::model_test
