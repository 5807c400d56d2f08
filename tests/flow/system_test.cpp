#include "graze/flow/system.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/tape/jet.hpp"
#include "model/chain.hpp"
#include "model/evaluate_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace graze::system_test {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Returns states near the initial one, followed by parameters: the inputs of a system's functions.
std::vector<double> inputs_near(const Model& model, std::mt19937& random) {
    std::uniform_real_distribution<double> spread(-0.01, 0.01);
    std::vector<double> inputs = model.initial_state();
    for (double& x : inputs)
        x += spread(random) * (1 + std::abs(x));
    const auto parameters = model.parameter_values();
    inputs.insert(inputs.end(), parameters.begin(), parameters.end());
    return inputs;
}

std::vector<double> evaluate(const Function& function, std::span<const double> inputs) {
    std::vector<double> outputs(function.outputs()), work(function.workspace());
    function.evaluate(inputs, outputs, work);
    return outputs;
}

class Systems : public ::testing::TestWithParam<std::string> {};

TEST_P(Systems, AgreeWithTheirExpressions) {
    const Model model = load_model(GetParam());
    const System system(model);
    ASSERT_EQ(system.states(), model.states.size());
    ASSERT_EQ(system.parameters(), model.parameter_values().size());
    std::mt19937 random(1);
    for (int trial = 0; trial < 5; ++trial) {
        const auto inputs = inputs_near(model, random);
        const std::span<const double> state(inputs.data(), system.states());
        const auto expect_equal = [&](const Function& function, const std::vector<Expression>& expressions) {
            const auto one = evaluate(function, inputs), other = testing::evaluate(model, expressions, state);
            ASSERT_EQ(one.size(), other.size());
            for (std::size_t i = 0; i < one.size(); ++i) {
                if (std::isfinite(other[i])) {
                    EXPECT_NEAR(one[i], other[i], 1e3 * epsilon * (1 + std::abs(other[i])));
                }
            }
        };
        for (std::size_t m = 0; m < model.modes.size(); ++m) {
            expect_equal(system.mode(m).rates, model.modes[m].rates);
            std::vector<Expression> functions;
            for (const std::size_t event : model.modes[m].watched)
                functions.push_back(model.events[event].function);
            expect_equal(system.mode(m).events, functions);
        }
        for (std::size_t j = 0; j < model.jumps.size(); ++j)
            if (!model.jumps[j].map.empty())
                expect_equal(system.jump(j).map, model.jumps[j].map);
    }
}

/// Returns the Jacobian of a jump row by row: states x (states + parameters).
std::vector<double> dense_jacobian(const System& system, std::size_t index, const std::vector<double>& inputs) {
    const System::CompiledJump& jump = system.jump(index);
    const std::size_t columns = system.states() + system.parameters();
    std::vector<double> dense(system.states() * columns, 0.0);
    for (std::size_t i = 0; i < system.states(); ++i)
        dense[i * columns + i] = std::count(jump.changed.begin(), jump.changed.end(), i) > 0 ? 0 : 1;
    const std::vector<double> values = evaluate(jump.jacobian, inputs);
    EXPECT_EQ(values.size(), jump.entries.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        EXPECT_EQ(std::count(jump.changed.begin(), jump.changed.end(), jump.entries[k].row), 1);
        dense[jump.entries[k].row * columns + jump.entries[k].column] = values[k];
    }
    return dense;
}

TEST_P(Systems, JumpJacobiansAgreeWithDifferences) {
    const Model model = load_model(GetParam());
    const System system(model);
    std::mt19937 random(2);
    const auto inputs = inputs_near(model, random);
    const std::size_t columns = system.states() + system.parameters();
    for (std::size_t j = 0; j < model.jumps.size(); ++j) {
        const std::vector<double> jacobian = dense_jacobian(system, j, inputs);
        for (std::size_t column = 0; column < columns; ++column) {
            auto above = inputs, below = inputs;
            const double h = 1e-6 * (1e-3 + std::abs(inputs[column]));
            above[column] += h;
            below[column] -= h;
            const auto high = evaluate(system.jump(j).map, above), low = evaluate(system.jump(j).map, below);
            for (std::size_t row = 0; row < system.states(); ++row) {
                const double difference = (high[row] - low[row]) / (above[column] - below[column]);
                const double round_off = epsilon * std::abs(high[row]) / h;
                EXPECT_NEAR(jacobian[row * columns + column], difference, 1e-6 * std::abs(difference) + 8 * round_off)
                    << model.jumps[j].name << ' ' << row << ' ' << column;
            }
        }
    }
}

TEST_P(Systems, TapesGiveRatesEventsAndObservedExpressions) {
    const Model model = load_model(GetParam());
    const std::vector<Expression> observed = {model.symbol(model.states[0].name) * 2.0};
    const System system = System(model).observing(observed);
    EXPECT_EQ(system.observed(), 1u);
    std::mt19937 random(3);
    const auto inputs = inputs_near(model, random);
    for (std::size_t m = 0; m < model.modes.size(); ++m) {
        const auto& mode = system.mode(m);
        EXPECT_EQ(mode.watched, model.modes[m].watched);
        const auto jet = make_jet(mode.tape, 8, LaneKind::single);
        jet->set_parameters(std::span(inputs).subspan(system.states()));
        jet->compute(std::span(inputs).first(system.states()));
        const auto rates = evaluate(mode.rates, inputs), events = evaluate(mode.events, inputs);
        for (std::size_t i = 0; i < system.states(); ++i) {
            EXPECT_EQ(jet->state(i)[0], inputs[i]);
            if (std::isfinite(rates[i])) {
                EXPECT_NEAR(jet->state(i)[1], rates[i], 1e3 * epsilon * (1 + std::abs(rates[i])));
            }
        }
        for (std::size_t w = 0; w < mode.watched.size(); ++w)
            EXPECT_NEAR(jet->output(w)[0], events[w], 1e3 * epsilon * (1 + std::abs(events[w])));
        for (int k = 0; k <= 8; ++k)
            EXPECT_EQ(jet->output(mode.watched.size())[k], 2 * jet->state(0)[k]);
    }
}

TEST_P(Systems, TransitionsAndPeriodsMatchTheModel) {
    const Model model = load_model(GetParam());
    const System system(model);
    const auto parameters = model.parameter_values();
    const auto periods = evaluate(system.periods(), parameters);
    for (std::size_t i = 0; i < system.states(); ++i)
        EXPECT_EQ(periods[i] > 0, model.states[i].period.has_value());
    for (std::size_t t = 0; t < model.transitions.size(); ++t) {
        const Transition& transition = model.transitions[t];
        EXPECT_EQ(system.transition(t).jump, transition.jump);
        ASSERT_EQ(system.transition(t).next.size(), transition.next.size());
        for (std::size_t a = 0; a < transition.next.size(); ++a) {
            EXPECT_EQ(system.transition(t).next[a].mode, transition.next[a].mode);
            EXPECT_EQ(system.transition(t).next[a].strict.size(), transition.next[a].when.size());
        }
        const auto& mode = system.mode(transition.mode);
        const auto found = std::find(mode.watched.begin(), mode.watched.end(), transition.event);
        ASSERT_NE(found, mode.watched.end());
        EXPECT_EQ(mode.transitions[static_cast<std::size_t>(found - mode.watched.begin())], t);
    }
}

TEST_P(Systems, GradientsOfSurfacesAgreeWithDifferences) {
    const Model model = load_model(GetParam());
    const System system(model);
    std::mt19937 random(5);
    const auto inputs = inputs_near(model, random);
    const auto expect_gradient = [&](const Function& function, const std::string& name) {
        const auto values = evaluate(function, inputs);
        ASSERT_EQ(values.size(), 1 + inputs.size());
        double terms = std::abs(values[0]); // which may cancel in the value, but not in its round-off
        for (std::size_t i = 0; i < inputs.size(); ++i)
            terms = std::max(terms, std::abs(values[1 + i] * inputs[i]));
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const double h = 1e-6 * std::max(std::abs(inputs[i]), 1e-3);
            auto above = inputs, below = inputs;
            above[i] += h;
            below[i] -= h;
            const double high = evaluate(function, above)[0], low = evaluate(function, below)[0];
            const double difference = (high - low) / (above[i] - below[i]);
            const double round_off = epsilon * std::max(std::abs(high), terms) / h;
            EXPECT_NEAR(values[1 + i], difference, 1e-6 * std::abs(difference) + 64 * round_off) << name << ' ' << i;
        }
    };
    for (std::size_t e = 0; e < model.events.size(); ++e) {
        expect_gradient(system.event(e), model.events[e].name);
        EXPECT_NEAR(evaluate(system.event(e), inputs)[0],
                    testing::evaluate(model, model.events[e].function, std::span(inputs).first(system.states())),
                    1e-12);
    }
    for (std::size_t s = 0; s < model.sections.size(); ++s)
        expect_gradient(system.section(s), model.sections[s].name);
    // The section of the image equals the section of the state after the symmetry's map.
    for (std::size_t m = 0; m < model.symmetries.size(); ++m)
        for (std::size_t s = 0; s < model.sections.size(); ++s) {
            expect_gradient(system.section(s, m), model.sections[s].name);
            auto image = evaluate(system.symmetry(m).map, inputs);
            image.insert(image.end(), inputs.begin() + static_cast<std::ptrdiff_t>(system.states()), inputs.end());
            EXPECT_NEAR(evaluate(system.section(s, m), inputs)[0], evaluate(system.section(s), image)[0],
                        8 * epsilon * (1 + std::abs(image[model.sections[s].state.value_or(0)])));
        }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Systems, ::testing::ValuesIn([] {
                             std::vector<std::string> names;
                             for (const CatalogueEntry& entry : catalogue())
                                 names.push_back(entry.name);
                             return names;
                         }()),
                         [](const auto& model) {
                             std::string name = model.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(System, RefusesInvalidModels) {
    Model model = load_model("bouncing-ball");
    model.modes[0].rates.pop_back();
    EXPECT_THROW(System{model}, InputError);
}

TEST(System, DoesNotDependOnLaterChangesOfTheModel) {
    auto model = std::make_unique<Model>(load_model("bouncing-ball"));
    const System system(*model);
    const std::size_t states = model->states.size();
    model->states.clear();
    model->set_parameter(model->parameters[0].name, 123);
    model.reset();
    EXPECT_EQ(system.model().states.size(), states);
    EXPECT_NE(system.model().parameter_values()[0], 123);
    EXPECT_NO_THROW(system.model().initial_state());
}

TEST(System, ModelCannotGrowButItsCopiesCan) {
    const System system(load_model("bouncing-ball"));
    const Model& frozen = system.model();
    const std::size_t size = frozen.graph->size();
    EXPECT_EQ(frozen.symbol(frozen.states[0].name).name(), frozen.states[0].name); // existing symbols can be used
    EXPECT_THROW(frozen.symbol("new_name"), OrderError);
    EXPECT_THROW(frozen.symbol(frozen.states[0].name) * 12345.678, OrderError);
    EXPECT_EQ(frozen.graph->size(), size);
    Model copy = frozen;
    EXPECT_NO_THROW(copy.symbol("new_name"));
    EXPECT_NO_THROW(copy.symbol(copy.states[0].name) * 12345.678);
    EXPECT_EQ(frozen.graph->size(), size);
}

TEST(System, AdoptsExpressionsOfAnyGraphByTheirSymbols) {
    const Model model = load_model("impact-oscillator");
    const System system(model);
    const auto graph = Graph::create();
    graph->symbol("something"); // indices differ
    const Expression own = sin(graph->symbol(model.states[1].name)) / 3 - graph->symbol(model.states[0].name);
    std::mt19937 random(7);
    const auto inputs = inputs_near(model, random);
    EXPECT_EQ(evaluate(system.function_of({{own}}), inputs)[0], std::sin(inputs[1]) / 3 - inputs[0]);
    EXPECT_EQ(evaluate(system.with_gradient(own), inputs)[1], -1);
    EXPECT_EQ(system.observing({{own}}).observed(), 1u);
    for (const Expression& wrong : {graph->symbol("something"), own + graph->symbol("something")}) {
        EXPECT_THROW(system.function_of({{wrong}}), InputError);
        EXPECT_THROW(system.with_gradient(wrong), InputError);
        EXPECT_THROW(system.observing({{wrong}}), InputError);
    }
    EXPECT_THROW(system.function_of({{Expression()}}), InputError);
    // Periods and the like are functions of parameters only.
    EXPECT_THROW(system.function_of_parameters({{own}}), InputError);
}

TEST(System, WithoutEventsHasNoWatchedEvents) {
    const System system = System(load_model("impact-microactuator")).without_events();
    for (std::size_t m = 0; m < system.model().modes.size(); ++m) {
        EXPECT_TRUE(system.mode(m).watched.empty());
        EXPECT_EQ(system.mode(m).events.outputs(), 0u);
    }
}

/// The compiled size of a chain of n oscillators with n barriers grows linearly: nothing is made for each pair.
TEST(SystemsOfManyEvents, GrowLinearly) {
    const auto size = [](std::size_t n) {
        const Model model = testing::chain(n);
        const System system(model);
        std::size_t entries = 0;
        for (std::size_t j = 1; j < model.jumps.size(); ++j) {
            EXPECT_EQ(system.jump(j).changed, std::vector<std::size_t>{2 * (j - 1) + 1});
            entries += system.jump(j).entries.size();
        }
        EXPECT_EQ(entries, n);
        EXPECT_EQ(system.jacobian_entries(), 1u);
        for (std::size_t w = 0; w < n; ++w)
            EXPECT_EQ(system.mode(0).gradients[w].states, std::vector<std::size_t>{2 * w});
        return std::pair(system.operations(), system.workspace());
    };
    const auto small = size(30), large = size(60), larger = size(120);
    EXPECT_EQ(larger.first - large.first, 2 * (large.first - small.first));
    EXPECT_EQ(larger.second - large.second, 2 * (large.second - small.second));
}

TEST(SystemsOfManyEvents, HaveTheMapsAndGradientsOfEachEvent) {
    const System system(testing::chain(3));
    const std::vector<double> inputs{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 1};
    EXPECT_EQ(evaluate(system.jump(2).map, inputs), (std::vector<double>{0.1, 0.2, 0.3, -0.7 * 0.4, 0.5, 0.6, 0.7}));
    EXPECT_EQ(evaluate(system.event(1), inputs), (std::vector<double>{0.6 - 0.3, 0, 0, -1, 0, 0, 0, 0, 0}));
    EXPECT_TRUE(system.jump(0).identity);
    EXPECT_EQ(evaluate(system.jump(0).map, inputs), std::vector<double>(inputs.begin(), inputs.end() - 1));
}

TEST_P(Systems, GradientsOfSingleEventsAreThoseOfAllEvents) {
    const Model model = load_model(GetParam());
    const System system(model);
    std::mt19937 random(4);
    const auto inputs = inputs_near(model, random);
    for (std::size_t m = 0; m < model.modes.size(); ++m) {
        const auto& mode = system.mode(m);
        const auto all = evaluate(mode.event_gradients, inputs);
        std::vector<double> filled(all.size(), 0.0);
        ASSERT_EQ(mode.gradients.size(), mode.watched.size());
        for (std::size_t w = 0; w < mode.gradients.size(); ++w) {
            const auto values = evaluate(mode.gradients[w].values, inputs);
            for (std::size_t k = 0; k < values.size(); ++k)
                filled[w * system.states() + mode.gradients[w].states[k]] = values[k];
        }
        EXPECT_EQ(filled, all);
    }
}

} // namespace graze::system_test
