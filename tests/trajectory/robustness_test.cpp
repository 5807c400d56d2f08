// Shipped models at random parameters end regularly: at the requested time, or by snap-through where the model has it.

#include "model_parts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace graze::robustness_test {

using namespace graze::testing;

struct Range {
    const char* parameter;
    double low, high;
};

struct Scenario {
    const char* model;
    double time;
    bool gap_may_close;
    std::vector<Range> ranges;
};

const std::vector<Scenario>& scenarios() {
    static const std::vector<Scenario> all = {
        {"bouncing-ball", 20, false, {{"a", 0, 0.02}, {"e", 0, 0.95}, {"f", 1, 30}}},
        {"ball-and-shaker", 20, false, {{"a", 0.1, 5}, {"e", 0, 0.9}, {"f", 1, 20}, {"b", 0.1, 1}}},
        {"impact-microactuator",
         200,
         false,
         {{"V", 0.1, 1.3}, {"omega", 0.2, 2.2}, {"e", 0, 0.95}, {"mu_d", 0.01, 0.39}}},
        {"impact-oscillator", 300, false, {{"omega", 0.1, 4}, {"sigma", -0.5, 1.5}, {"e", 0, 0.95}}},
        {"impact-oscillator-two-stops", 300, false, {{"omega", 0.1, 4}, {"sigma", 0.05, 1.5}, {"e", 0, 0.95}}},
        {"dry-friction-oscillator", 300, false, {{"omega", 0.1, 3}}},
        {"electromagnetic-testbed", 10, false, {{"V0", 1, 9}, {"f", 2, 10}, {"e", 0, 0.95}}},
        {"mems-switch", 300, true, {{"V", 0.05, 0.4}, {"e", 0, 0.95}, {"omega", 0.3, 3}, {"delta", 0.1, 0.6}}},
        {"microbeam", 3, true, {{"V", 0.001, 0.05}, {"k", 0, 5000}}},
    };
    return all;
}

class Robustness : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Robustness, RandomParametersEndRegularly) {
    const Scenario& scenario = scenarios()[GetParam()];
    std::mt19937_64 random(20 + GetParam());
    const auto draw = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const double tolerances[] = {1e-6, 1e-9, 1e-12, 1e-14};
    for (int sample = 0; sample < 60; ++sample) {
        Model model = load_model(scenario.model);
        std::string setting;
        for (const Range& range : scenario.ranges) {
            double value = draw(range.low, range.high);
            if (std::string(range.parameter) == "e" && sample % 5 == 0)
                value = 0;
            model.set_parameter(range.parameter, value);
            setting += std::string(" ") + range.parameter + "=" + std::to_string(value);
        }
        const Simulation simulation(System(model), {}, {},
                                    {.tolerance = tolerances[sample % 4], .step_limit = 3'000'000});
        Trajectory trajectory(simulation, model.parameter_values());
        trajectory.start(model.initial_state(), model.initial_mode, 0, scenario.time);
        run(trajectory);
        const Ending ending = trajectory.outcome().ending;
        EXPECT_TRUE(ending == Ending::end_time ||
                    (scenario.gap_may_close && (ending == Ending::singular || ending == Ending::terminal)))
            << scenario.model << setting << ": " << name_of(ending) << ": " << trajectory.outcome().detail;
        for (const double x : trajectory.state())
            EXPECT_TRUE(std::isfinite(x)) << scenario.model << setting;
    }
}

INSTANTIATE_TEST_SUITE_P(ShippedModels, Robustness, ::testing::Range<std::size_t>(0, scenarios().size()));

/// A mass that constant forces pull to a ridge from either side, and that loses speed at each crossing, like a block
/// that rocks from edge to edge. Crossings accumulate although no event is followed by itself.
Model ridge(bool with_rest) {
    std::string text = R"(
name = "ridge"
parameters = { g = 9.81, e = 0.9 }
states = { x = 0.5, v = 0 }
events = { leftwards = "x", rightwards = "-x" }
modes.right = { rates = { x = "v", v = "-g" }, watch = ["leftwards"] }
modes.left = { rates = { x = "v", v = "g" }, watch = ["rightwards"] }
modes.rest = { rates = { x = 0, v = 0 } }
initial.mode = "right"
jumps.lose.v = "e*v"
jumps.stop = { x = 0, v = 0 }
)";
    for (const auto& [mode, event, next] :
         {std::array{"right", "leftwards", "left"}, {"left", "rightwards", "right"}}) {
        text += transition(mode, event, next, "lose");
        if (with_rest)
            text += "chatter = { jump = 'stop', mode = 'rest' }\n";
    }
    return parse_model(text, "ridge.toml");
}

struct Rest : Observer {
    double time = -1;
    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::sticking)
            time = contact.time;
    }
};

TEST(StandStill, CrossingsThatAccumulateBetweenTwoModesComeToRest) {
    for (const bool with_rest : {true, false}) {
        const Model model = ridge(with_rest);
        const Simulation simulation{System(model)};
        Rest rest;
        Trajectory trajectory(simulation, model.parameter_values(), borrowed(rest));
        trajectory.start(model.initial_state(), model.initial_mode, 0, 100);
        run(trajectory);
        const double fall = std::sqrt(2 * 0.5 / 9.81), expected = fall * (1 + 0.9) / (1 - 0.9);
        EXPECT_EQ(trajectory.outcome().ending, with_rest ? Ending::end_time : Ending::chatter);
        // Positions are known to 1e-17, so the last part of the sum, flights of less than 1e-9, is known only roughly.
        EXPECT_NEAR(with_rest ? rest.time : trajectory.outcome().time, expected, 1e-10);
    }
}

} // namespace graze::robustness_test
