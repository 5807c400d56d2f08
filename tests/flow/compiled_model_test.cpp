#include "graze/flow/compiled_model.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/tape/jet.hpp"
#include "model/evaluate_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace graze {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// States near the initial one, followed by parameters: the inputs of a compiled model's functions.
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

class CompiledModels : public ::testing::TestWithParam<std::string> {};

TEST_P(CompiledModels, AgreeWithTheirExpressions) {
    const Model model = load_model(GetParam());
    const CompiledModel compiled(model);
    ASSERT_EQ(compiled.states(), model.states.size());
    ASSERT_EQ(compiled.parameters(), model.parameter_values().size());
    std::mt19937 random(1);
    for (int trial = 0; trial < 5; ++trial) {
        const auto inputs = inputs_near(model, random);
        const std::span<const double> state(inputs.data(), compiled.states());
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
            expect_equal(compiled.mode(m).rates, model.modes[m].rates);
            std::vector<Expression> functions;
            for (const std::size_t event : model.modes[m].watched)
                functions.push_back(model.events[event].function);
            expect_equal(compiled.mode(m).events, functions);
        }
        for (std::size_t j = 0; j < model.jumps.size(); ++j)
            if (!model.jumps[j].map.empty())
                expect_equal(compiled.jump(j).map, model.jumps[j].map);
    }
}

TEST_P(CompiledModels, JumpJacobiansAgreeWithDifferences) {
    const Model model = load_model(GetParam());
    const CompiledModel compiled(model);
    std::mt19937 random(2);
    const auto inputs = inputs_near(model, random);
    const std::size_t columns = compiled.states() + compiled.parameters();
    for (std::size_t j = 0; j < model.jumps.size(); ++j) {
        const auto jacobian = evaluate(compiled.jump(j).jacobian, inputs);
        ASSERT_EQ(jacobian.size(), compiled.states() * columns);
        for (std::size_t column = 0; column < columns; ++column) {
            auto above = inputs, below = inputs;
            const double h = 1e-6 * (1e-3 + std::abs(inputs[column]));
            above[column] += h;
            below[column] -= h;
            const auto high = evaluate(compiled.jump(j).map, above), low = evaluate(compiled.jump(j).map, below);
            for (std::size_t row = 0; row < compiled.states(); ++row) {
                const double difference = (high[row] - low[row]) / (above[column] - below[column]);
                const double round_off = epsilon * std::abs(high[row]) / h;
                EXPECT_NEAR(jacobian[row * columns + column], difference, 1e-6 * std::abs(difference) + 8 * round_off)
                    << model.jumps[j].name << ' ' << row << ' ' << column;
            }
        }
    }
}

TEST_P(CompiledModels, TapesGiveRatesEventsAndObserved) {
    const Model model = load_model(GetParam());
    const std::vector<Expression> observed = {model.symbol(model.states[0].name) * 2.0};
    const CompiledModel compiled(model, observed);
    EXPECT_EQ(compiled.observed(), 1u);
    std::mt19937 random(3);
    const auto inputs = inputs_near(model, random);
    for (std::size_t m = 0; m < model.modes.size(); ++m) {
        const auto& mode = compiled.mode(m);
        EXPECT_EQ(mode.watched, model.modes[m].watched);
        const auto jet = make_jet(mode.tape, 8, LaneKind::single);
        jet->set_parameters(std::span(inputs).subspan(compiled.states()));
        jet->compute(std::span(inputs).first(compiled.states()));
        const auto rates = evaluate(mode.rates, inputs), events = evaluate(mode.events, inputs);
        for (std::size_t i = 0; i < compiled.states(); ++i) {
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

TEST_P(CompiledModels, TransitionsAndPeriodsMatchTheModel) {
    const Model model = load_model(GetParam());
    const CompiledModel compiled(model);
    const auto parameters = model.parameter_values();
    const auto periods = evaluate(compiled.periods(), parameters);
    for (std::size_t i = 0; i < compiled.states(); ++i)
        EXPECT_EQ(periods[i] > 0, model.states[i].period.has_value());
    for (std::size_t t = 0; t < model.transitions.size(); ++t) {
        const Transition& transition = model.transitions[t];
        EXPECT_EQ(compiled.transition(t).jump, transition.jump);
        ASSERT_EQ(compiled.transition(t).next.size(), transition.next.size());
        for (std::size_t a = 0; a < transition.next.size(); ++a) {
            EXPECT_EQ(compiled.transition(t).next[a].mode, transition.next[a].mode);
            EXPECT_EQ(compiled.transition(t).next[a].strict.size(), transition.next[a].when.size());
        }
        const auto& mode = compiled.mode(transition.mode);
        const auto found = std::find(mode.watched.begin(), mode.watched.end(), transition.event);
        ASSERT_NE(found, mode.watched.end());
        EXPECT_EQ(mode.transitions[static_cast<std::size_t>(found - mode.watched.begin())], t);
    }
}

INSTANTIATE_TEST_SUITE_P(Shipped, CompiledModels, ::testing::ValuesIn([] {
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

TEST(CompiledModel, RefusesModelsThatAreNotValid) {
    Model model = load_model("bouncing-ball");
    model.modes[0].rates.pop_back();
    EXPECT_THROW(CompiledModel{model}, InputError);
}

} // namespace
} // namespace graze
