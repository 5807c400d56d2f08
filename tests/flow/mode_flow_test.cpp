#include "graze/flow/mode_flow.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/microbeam.hpp"
#include "graze/model/model_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace graze::mode_flow_test {

/// x'' = -k x, whose flow and derivatives are known, and a barrier that the flow ignores.
Model spring() {
    return parse_model(R"(
name = "spring"
parameters = { c = 7, k = 4 }
states = { x = 1, v = 0 }
events = { wall = "x - 0.5" }
modes.free = { rates = { x = "v", v = "-k*x" }, watch = ["wall"] }
jumps.impact.v = "-v"
transitions = [{ mode = "free", event = "wall", jump = "impact", next = "free" }]
)",
                       "spring.toml");
}

constexpr double tolerance = 1e-15, accuracy = 1e-13;

TEST(ModeFlow, AgreesWithClosedFormsForwardsAndBackwards) {
    ModeFlow flow(System(spring()), tolerance, 0, {ParameterId(1)});
    for (const double k : {4.0, 0.3})
        for (const double time : {0.0, 0.7, 3.1, -2.2}) {
            flow.set_parameters(std::vector{7.0, k});
            const double w = std::sqrt(k), c = std::cos(w * time), s = std::sin(w * time), x = 0.8, v = -0.3;
            std::vector<double> state{x, v}, alone = state, derivatives(2 * 3);
            ASSERT_EQ(flow.run(0, state, time, derivatives), ModeFlow::Ending::done);
            ASSERT_EQ(flow.run(0, alone, time), ModeFlow::Ending::done);
            // By the angular frequency w, then by k = w^2.
            const double x_by_w = -x * time * s + v * (time * c / w - s / (w * w)),
                         v_by_w = -x * (s + w * time * c) - v * time * s;
            const std::vector<double> exact{c, s / w, x_by_w / (2 * w), -w * s, c, v_by_w / (2 * w)};
            EXPECT_NEAR(state[0], x * c + v * s / w, accuracy);
            EXPECT_NEAR(state[1], v * c - x * w * s, accuracy);
            for (std::size_t i = 0; i < 2; ++i)
                EXPECT_NEAR(alone[i], state[i], accuracy);
            for (std::size_t i = 0; i < exact.size(); ++i)
                EXPECT_NEAR(derivatives[i], exact[i], 10 * accuracy) << i << ' ' << k << ' ' << time;
        }
}

TEST(ModeFlow, ShowsItsStepsAndIgnoresEvents) {
    ModeFlow flow(System(spring()), tolerance);
    flow.set_parameters(std::vector{7.0, 4.0});
    std::vector<double> state{1, 0};
    double reached = 0;
    std::size_t steps = 0;
    ASSERT_EQ(flow.run(0, state, 1.0,
                       [&](const Jet& jet, double time, double length) {
                           EXPECT_EQ(time, reached);
                           EXPECT_NEAR(jet.output(0)[0], std::cos(2 * time) - 0.5, accuracy);
                           reached += length;
                           ++steps;
                       }),
              ModeFlow::Ending::done);
    EXPECT_NEAR(reached, 1.0, 1e-15);
    EXPECT_EQ(flow.steps(), steps);
    EXPECT_NEAR(state[0], std::cos(2.0), accuracy); // beyond the barrier
}

TEST(ModeFlow, ComputesDerivativesForChosenStatesOnly) {
    const System system(spring());
    ModeFlow all(system, tolerance, 0, {ParameterId(1)}),
        some(system, tolerance, 0, {ParameterId(1)}, std::vector<std::size_t>{1}),
        none(system, tolerance, 0, {}, std::vector<std::size_t>{});
    std::vector<double> state{0.8, -0.3}, other = state, alone = state, every(2 * 3), few(2 * 2);
    for (ModeFlow* flow : {&all, &some, &none})
        flow->set_parameters(std::vector{7.0, 4.0});
    ASSERT_EQ(all.run(0, state, 3.1, every), ModeFlow::Ending::done);
    ASSERT_EQ(some.run(0, other, 3.1, few), ModeFlow::Ending::done);
    ASSERT_EQ(none.run(0, alone, 3.1, std::span<double>()), ModeFlow::Ending::done);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(other[i], state[i], accuracy);
        EXPECT_NEAR(alone[i], state[i], accuracy);
        EXPECT_NEAR(few[2 * i], every[3 * i + 1], 10 * accuracy);
        EXPECT_NEAR(few[2 * i + 1], every[3 * i + 2], 10 * accuracy);
    }
    EXPECT_THROW(ModeFlow(system, tolerance, 0, {}, std::vector<std::size_t>{2}), InputError);
}

/// The second mode of the beam is antisymmetric: terms of its coupling to the first cancel and leave round-off.
TEST(ModeFlow, TakesFewStepsWhereASymmetryMakesDerivativesZero) {
    for (const double within : {1e-9, 1e-12, tolerance}) {
        const Model model = microbeam({.modes = 2});
        ModeFlow flow(System(model), within, 0, {ParameterId(0)});
        flow.set_parameters(model.parameter_values());
        const std::size_t n = model.states.size();
        std::vector<double> state = model.initial_state(), other = state, derivatives(n * (n + 1));
        ASSERT_EQ(flow.run(0, state, 0.07), ModeFlow::Ending::done);
        const std::size_t steps = flow.steps();
        ASSERT_EQ(flow.run(0, other, 0.07, derivatives), ModeFlow::Ending::done);
        EXPECT_LE(flow.steps() - steps, 2 * steps);
        for (std::size_t i = 0; i < n; ++i)
            EXPECT_NEAR(other[i], state[i], 10 * within);
        const std::size_t first = model.find_state("q1").value(), second = model.find_state("q2").value();
        EXPECT_LT(std::abs(derivatives[first * (n + 1) + second]), 1e-13);
        EXPECT_GT(std::abs(derivatives[first * (n + 1) + first]), 1e-3);
    }
}

TEST(ModeFlow, ReportsHowItEnds) {
    const Model model = parse_model("name = \"a\"\n[states]\nx = 1\n[modes.m]\nrates = { x = \"x^2\" }\n"
                                    "[initial]\nmode = \"m\"\n",
                                    "a.toml");
    ModeFlow flow(System(model), tolerance);
    std::vector<double> state{1.0};
    EXPECT_EQ(flow.run(0, state, 2.0), ModeFlow::Ending::singular); // 1/(1 - t)
    state = {1.0};
    EXPECT_EQ(flow.run(0, state, std::numeric_limits<double>::infinity()), ModeFlow::Ending::undefined);
}

/// More directions than one jet computes at once follow steps in parts where they are faster: the last two states are
/// at rest and do not limit steps, but their derivatives rotate with angle k t.
TEST(ModeFlow, FollowsFastDirectionsInPartsUpToALimit) {
    std::string text = "name = \"rest\"\n[parameters]\nk = 1000\n[states]\n", rates;
    for (const char* slow : {"a", "b", "c", "d", "e", "f", "g", "h"}) {
        text += std::string(slow) + " = 1\n";
        rates += std::string(slow) + " = \"-" + slow + "\", ";
    }
    text += "y = 0\nz = 0\n[modes.m]\nrates = { " + rates + "y = \"k*z\", z = \"-k*y\" }\n[initial]\nmode = \"m\"\n";
    const Model model = parse_model(text, "rest.toml");
    ModeFlow flow(System(model), tolerance);
    const std::size_t n = model.states.size();
    std::vector<double> state = model.initial_state(), derivatives(n * n);
    flow.set_parameters(std::vector<double>{1000});
    ASSERT_EQ(flow.run(0, state, 0.02, derivatives), ModeFlow::Ending::done);
    EXPECT_NEAR(derivatives.back(), std::cos(20.0), accuracy);
    EXPECT_NEAR(derivatives.front(), std::exp(-0.02), accuracy);
    flow.set_parameters(std::vector<double>{1e7});
    state = model.initial_state();
    EXPECT_EQ(flow.run(0, state, 1.0, derivatives), ModeFlow::Ending::too_long);
}

} // namespace graze::mode_flow_test
