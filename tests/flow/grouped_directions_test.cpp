#include "flow/grouped_directions.hpp"

#include "graze/flow/mode_flow.hpp"
#include "model/chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace graze::grouped_directions_test {

constexpr double tolerance = 1e-14;

std::vector<std::size_t> all_states(const System& system) {
    std::vector<std::size_t> result(system.states());
    std::iota(result.begin(), result.end(), std::size_t{0});
    return result;
}

std::unique_ptr<GroupedDirections> groups_of(const System& system, int order) {
    return GroupedDirections::of(system, 0, tolerance, order, all_states(system), std::vector{ParameterId(0)});
}

/// x_i'' = x_{i-1} - 2 x_i + x_{i+1} between fixed ends.
Model linear_chain(std::size_t oscillators) {
    Model model;
    model.name = "linear-chain";
    model.parameters.push_back({"unused", "", "", 1, std::nullopt});
    for (const char* stem : {"x", "v"})
        for (std::size_t i = 1; i <= oscillators; ++i)
            model.states.push_back({stem + std::to_string(i), "", "", model.number(0), {}, false});
    const std::vector<Expression> states = model.state_symbols();
    Mode mode{"free", "", {states.begin() + static_cast<std::ptrdiff_t>(oscillators), states.end()}, {}};
    for (std::size_t i = 0; i < oscillators; ++i) {
        Expression rate = -2 * states[i];
        if (i > 0)
            rate = rate + states[i - 1];
        if (i + 1 < oscillators)
            rate = rate + states[i + 1];
        mode.rates.push_back(rate);
    }
    model.modes.push_back(std::move(mode));
    model.jumps[0].map = states;
    return model;
}

/// A disturbance of an oscillator reaches half as many oscillators on either side as the series has orders:
/// displacements and velocities within this distance need groups of their own, and the phase of the force one more.
TEST(GroupedDirections, AreAsManyAsStatesWithinReach) {
    const System system(testing::chain(120));
    for (const int order : {4, 10, 20}) {
        const auto groups = groups_of(system, order);
        ASSERT_TRUE(groups) << order;
        const auto within = static_cast<std::size_t>(order + 1);
        EXPECT_GE(groups->groups(), 2 * within - 1) << order;
        EXPECT_LE(groups->groups(), 2 * within + 1) << order;
    }
}

TEST(GroupedDirections, AreNotFormedWhereTheySaveLittle) {
    EXPECT_FALSE(groups_of(System(testing::chain(20)), 4));   // few states
    EXPECT_FALSE(groups_of(System(testing::chain(120)), 80)); // all are within reach
}

/// The displacements are sums of waves cos(w_k t) sin(k pi i / (n + 1)), w_k = 2 sin(k pi / (2 n + 2)).
TEST(GroupedDirections, GiveTheDerivativesOfALinearChain) {
    constexpr std::size_t n = 90, states = 2 * n;
    constexpr double time = 7.3;
    const System system(linear_chain(n));
    ASSERT_TRUE(groups_of(system, 20));
    ModeFlow flow(system, tolerance);
    flow.set_parameters(std::vector{1.0});
    std::vector<double> state(states), derivatives(states * states);
    for (std::size_t i = 0; i < states; ++i)
        state[i] = std::cos(static_cast<double>(i));
    ASSERT_EQ(flow.run(0, state, time, derivatives), ModeFlow::Ending::done);
    constexpr double angle = std::numbers::pi / (n + 1);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            double x_by_x = 0, x_by_v = 0, v_by_x = 0;
            for (std::size_t k = 1; k <= n; ++k) {
                const double frequency = 2 * std::sin(0.5 * angle * static_cast<double>(k)),
                             share = 2.0 / (n + 1) * std::sin(angle * static_cast<double>(k * (i + 1))) *
                                     std::sin(angle * static_cast<double>(k * (j + 1)));
                x_by_x += share * std::cos(frequency * time);
                x_by_v += share * std::sin(frequency * time) / frequency;
                v_by_x -= share * std::sin(frequency * time) * frequency;
            }
            EXPECT_NEAR(derivatives[i * states + j], x_by_x, 1e-12);
            EXPECT_NEAR(derivatives[i * states + n + j], x_by_v, 1e-12);
            EXPECT_NEAR(derivatives[(n + i) * states + j], v_by_x, 1e-12);
            EXPECT_NEAR(derivatives[(n + i) * states + n + j], x_by_x, 1e-12);
        }
}

/// Directions of a few states are followed one by one. Their derivatives along a nonlinear motion, forwards and
/// backwards, are the same to within the tolerance of each step.
TEST(GroupedDirections, AgreeWithDirectionsThatAreFollowedOneByOne) {
    constexpr std::size_t n = 100, states = 2 * n + 1, columns = states + 1;
    const System system(testing::chain(n));
    const std::vector<ParameterId> free{ParameterId(0)};
    const std::vector<std::size_t> chosen{0, 7, n - 1, n, n + 50, 2 * n};
    const std::size_t few = chosen.size() + free.size();
    ModeFlow all(system, tolerance, 0, free), some(system, tolerance, 0, free, chosen);
    for (const double time : {6.0, -1.5}) {
        std::vector<double> state(states), other, derivatives(states * columns), expected(states * few);
        for (std::size_t i = 0; i < states; ++i)
            state[i] = 0.5 * std::cos(1.3 * static_cast<double>(i));
        other = state;
        for (ModeFlow* flow : {&all, &some})
            flow->set_parameters(system.model().parameter_values());
        ASSERT_EQ(all.run(0, state, time, derivatives), ModeFlow::Ending::done);
        ASSERT_EQ(some.run(0, other, time, expected), ModeFlow::Ending::done);
        for (std::size_t i = 0; i < states; ++i) {
            EXPECT_NEAR(state[i], other[i], 1e-12);
            for (std::size_t d = 0; d < few; ++d) {
                const std::size_t column = d < chosen.size() ? chosen[d] : states + d - chosen.size();
                EXPECT_NEAR(derivatives[i * columns + column], expected[i * few + d], 1e-12) << i << ' ' << d;
            }
        }
    }
}

} // namespace graze::grouped_directions_test
