// That lanes agree with one trajectory, derivatives with differences and with the variational equations, and
// instruction sets with each other.

#include "graze/tape/jet.hpp"

#include "graze/symbolic/transform.hpp"
#include "tape/problems.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

using testing::eps;
using testing::Problem;
using testing::spread;

/// Coefficients of states and outputs of one lane, one after another.
std::vector<double> lane(const Jet& jet, const Problem& problem, int lane) {
    std::vector<double> numbers;
    const auto append = [&](const double* series) {
        for (int k = 0; k <= jet.order(); ++k)
            numbers.push_back(series[k * jet.width() + lane]);
    };
    for (std::size_t i = 0; i < problem.states.size(); ++i)
        append(jet.state(i));
    for (std::size_t i = 0; i < problem.outputs.size(); ++i)
        append(jet.output(i));
    return numbers;
}

std::vector<double> series_of(const Problem& problem, int order, InstructionSet set, const std::vector<double>& states,
                              const std::vector<double>& parameters) {
    const Tape tape = problem.tape();
    const auto jet = make_jet(tape, order, LaneKind::single, set);
    jet->set_parameters(parameters);
    jet->compute(states);
    return lane(*jet, problem, 0);
}

TEST(Lanes, EnsembleEqualsSingleBitForBit) {
    const Problem p = testing::everything();
    const Tape tape = p.tape();
    for (const auto set : testing::supported_sets())
        for (int order = 1; order <= highest_order; ++order) {
            const auto jet = make_jet(tape, order, LaneKind::ensemble, set);
            ASSERT_EQ(jet->width(), lanes_of(LaneKind::ensemble, set));
            const auto parameter = [&](std::size_t i, int l) { return p.parameter_values[i] + 0.003 * l; };
            const auto state = [&](std::size_t i, int l) { return p.state_values[i] - 0.002 * l; };
            jet->set_parameters(spread(p.parameter_values, jet->width(), parameter));
            jet->compute(spread(p.state_values, jet->width(), state));
            for (int l = 0; l < jet->width(); ++l)
                ASSERT_EQ(lane(*jet, p, l),
                          series_of(p, order, set,
                                    spread(p.state_values, 1, [&](std::size_t i, int) { return state(i, l); }),
                                    spread(p.parameter_values, 1, [&](std::size_t i, int) { return parameter(i, l); })))
                    << "lane " << l << " order " << order << " " << name_of(set);
        }
}

TEST(Lanes, TangentValueEqualsSingleBitForBit) {
    const Problem p = testing::everything();
    const Tape tape = p.tape();
    for (const auto set : testing::supported_sets())
        for (int order = 1; order <= highest_order; ++order) {
            const auto jet = make_jet(tape, order, LaneKind::tangent, set);
            ASSERT_EQ(jet->width(), 1 + lanes_of(LaneKind::tangent, set));
            const auto direction = [](const std::vector<double>& values) {
                return [&](std::size_t i, int l) { return l == 0 ? values[i] : std::sin(3.0 * double(i) + l); };
            };
            jet->set_parameters(spread(p.parameter_values, jet->width(), direction(p.parameter_values)));
            jet->compute(spread(p.state_values, jet->width(), direction(p.state_values)));
            ASSERT_EQ(lane(*jet, p, 0), series_of(p, order, set, p.state_values, p.parameter_values))
                << "order " << order << " " << name_of(set);
        }
}

/// Size of coefficients of an order, to which errors are compared.
std::vector<double> sizes(const std::vector<double>& series, int order) {
    std::vector<double> size(static_cast<std::size_t>(order) + 1, 0.0);
    for (std::size_t i = 0; i < series.size(); ++i) {
        double& largest = size[i % size.size()];
        largest = std::max(largest, std::abs(series[i]));
    }
    return size;
}

TEST(Lanes, InstructionSetsAgree) {
    const Problem p = testing::everything();
    constexpr int order = 20;
    const auto reference = series_of(p, order, InstructionSet::baseline, p.state_values, p.parameter_values);
    const auto size = sizes(reference, order);
    for (const auto set : testing::supported_sets()) {
        const auto series = series_of(p, order, set, p.state_values, p.parameter_values);
        for (std::size_t i = 0; i < series.size(); ++i)
            EXPECT_NEAR(series[i], reference[i], 20 * eps * size[i % size.size()]) << i << " " << name_of(set);
    }
}

/// Each direction in turn is one state or parameter.
TEST(Lanes, TangentsMatchDifferences) {
    const Problem p = testing::everything();
    const Tape tape = p.tape();
    constexpr int order = 12;
    constexpr double step = 1e-5;
    for (const auto set : testing::supported_sets()) {
        const int directions = lanes_of(LaneKind::tangent, set);
        const auto jet = make_jet(tape, order, LaneKind::tangent, set);
        for (std::size_t variable = 0; variable < p.states.size() + p.parameters.size(); ++variable) {
            const int chosen = 1 + static_cast<int>(variable) % directions;
            const auto unit = [&](const std::vector<double>& values, std::size_t first) {
                return [&values, first, variable, chosen](std::size_t i, int l) {
                    return l == 0 ? values[i] : (l == chosen && i + first == variable ? 1.0 : 0.0);
                };
            };
            jet->set_parameters(spread(p.parameter_values, jet->width(), unit(p.parameter_values, p.states.size())));
            jet->compute(spread(p.state_values, jet->width(), unit(p.state_values, 0)));
            const auto moved = [&](double by) {
                auto states = p.state_values;
                auto parameters = p.parameter_values;
                (variable < states.size() ? states[variable] : parameters[variable - states.size()]) += by;
                return series_of(p, order, set, states, parameters);
            };
            const auto ahead = moved(step);
            const auto behind = moved(-step);
            const auto tangent = lane(*jet, p, chosen);
            const auto size = sizes(tangent, order);
            for (std::size_t i = 0; i < tangent.size(); ++i)
                EXPECT_NEAR(tangent[i], (ahead[i] - behind[i]) / (2 * step), 1e-7 * (1 + size[i % size.size()]))
                    << "variable " << variable << " number " << i << " " << name_of(set);
            if (directions > 1) { // directions in which nothing moves
                for (const double number : lane(*jet, p, 1 + chosen % directions))
                    ASSERT_EQ(number, 0);
            }
        }
    }
}

TEST(Lanes, TangentsMatchVariationalEquations) {
    const Problem p = testing::everything();
    const Tape tape = p.tape();
    constexpr int order = 20;
    // Coefficients 0 .. order of the derivative in direction (d0, d1, ...) of states, by a larger vector field.
    Problem variational = p;
    for (std::size_t j = 0; j < p.states.size(); ++j)
        variational.state("d" + std::to_string(j), 0.3 + 0.2 * double(j));
    const auto derivative = [&](const Expression& expression) {
        Expression sum = p.graph->number(0);
        for (std::size_t j = 0; j < p.states.size(); ++j)
            sum = sum + differentiate(expression, p.states[j]) * variational.states[p.states.size() + j];
        return sum;
    };
    for (const Expression& rate : p.rates)
        variational.rates.push_back(derivative(rate));
    variational.outputs.clear();
    for (const Expression& output : p.outputs)
        variational.outputs.push_back(derivative(output));

    for (const auto set : testing::supported_sets()) {
        const auto reference =
            series_of(variational, order, set, variational.state_values, variational.parameter_values);
        const auto jet = make_jet(tape, order, LaneKind::tangent, set);
        jet->set_parameters(spread(p.parameter_values, jet->width(),
                                   [&](std::size_t i, int l) { return l == 0 ? p.parameter_values[i] : 0.0; }));
        jet->compute(spread(p.state_values, jet->width(), [&](std::size_t i, int l) {
            return l == 0 ? p.state_values[i] : variational.state_values[p.states.size() + i];
        }));
        const auto tangent = lane(*jet, p, jet->width() - 1);
        // The larger vector field has the states first.
        const std::size_t skipped = p.states.size() * (order + 1);
        ASSERT_EQ(reference.size(), tangent.size() + skipped);
        const auto size = sizes(reference, order);
        for (std::size_t i = 0; i < tangent.size(); ++i)
            EXPECT_NEAR(tangent[i], reference[i + skipped], 200 * eps * size[i % size.size()])
                << i << " " << name_of(set);
    }
}

/// A lane with an infinite slope in a direction that does not matter must not spoil anything.
TEST(Lanes, DirectionsThatDoNotMatterStayZero) {
    Problem p;
    const Expression x = p.state("x", 0);
    const Expression a = p.parameter("a", 0);
    p.parameter("b", 1);
    p.rates = {sqrt(a) + pow(a, 1.5) + p.graph->number(1)};
    p.outputs = {pow(x, 4) + x * x};
    const Tape tape = p.tape();
    for (const auto set : testing::supported_sets()) {
        const auto jet = make_jet(tape, 6, LaneKind::tangent, set);
        jet->set_parameters(spread(p.parameter_values, jet->width(), [&](std::size_t i, int l) {
            return l == 0 ? p.parameter_values[i] : (i == 1 ? 1.0 : 0.0);
        }));
        jet->compute(spread(p.state_values, jet->width(), [](std::size_t, int l) { return l == 0 ? 0.0 : 1.0; }));
        for (int l = 0; l < jet->width(); ++l)
            for (const double number : lane(*jet, p, l))
                EXPECT_TRUE(std::isfinite(number));
        EXPECT_EQ(jet->output(0)[1 * jet->width() + 1], 2); // d(t + dx)^2/dx at order 1
        EXPECT_EQ(jet->output(0)[3 * jet->width() + 1], 4);
    }
}

} // namespace
} // namespace graze
