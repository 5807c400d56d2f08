#include "graze/flow/derivative_check.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace graze::derivative_check_test {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;

TEST(DerivativeCheck, FindsNothingInShippedModels) {
    for (const char* name : {"impact-oscillator", "electromagnetic-testbed", "mems-switch", "bouncing-ball"}) {
        const System system(load_model(name));
        std::vector<double> state = system.model().initial_state();
        for (std::size_t i = 0; i < state.size(); ++i)
            state[i] += 0.01 * static_cast<double>(i + 1);
        for (const DerivativeFinding& finding : check_derivatives(system, state, system.model().parameter_values()))
            ADD_FAILURE() << name << ": " << finding.part << ": " << finding.text();
    }
}

/// A rate with a corner that is closer than any difference: its derivative is 1 on this side, and differences give 0.
TEST(DerivativeCheck, TellsWhichDerivativeDisagreesAndByHowMuch) {
    const System system(parse_model(R"toml(
name = "corner"
parameters = { p = 1 }
states = { x = 1, y = 1 }
modes.only = { rates = { x = "p*y", y = "sqrt((x - 1)^2 + 1e-30)" }, watch = ["root"] }
events = { root = "log(y - 1) + x" }
jumps.turn.x = "-x"
transitions = [{ mode = "only", event = "root", jump = "turn", next = "only" }]
)toml",
                                    "corner.toml"));
    const auto findings = check_derivatives(system, std::vector{1 + 1e-9, 1.0}, std::vector{1.0});
    ASSERT_THAT(findings, Contains(Field(&DerivativeFinding::what, "the rate of y by x")));
    for (const DerivativeFinding& finding : findings)
        if (finding.what == "the rate of y by x") {
            EXPECT_EQ(finding.part, "modes.only");
            EXPECT_NEAR(finding.exact, 1, 1e-6);
            EXPECT_NEAR(finding.difference, 0, 1e-3);
            EXPECT_THAT(finding.text(), HasSubstr("the derivative of the rate of y by x is 1, where differences give"));
        }
    // An event that is not defined where the motion is cannot be watched there.
    ASSERT_THAT(findings, Contains(Field(&DerivativeFinding::part, "events.root")));
    EXPECT_THAT(findings.back().text(), HasSubstr("the function is not defined at the state"));
}

/// A force that begins with a power exists on one side of its event only; the flow of its mode goes on beyond.
TEST(DerivativeCheck, FindsNothingBesideTheBeginningOfAPower) {
    const System system(parse_model(R"toml(
name = "hertz"
parameters = { k = 50, c = 0.5, n = 2.5 }
states = { x = 0, v = 0 }
modes.free = { rates = { x = "v", v = "-x" }, watch = ["touch"] }
modes.contact = { rates = { x = "v", v = "-x - k*(x - 0.5)^1.5*(1 + c*v) - (x - 0.5)^n" }, watch = ["loss"] }
events = { touch = "0.5 - x", loss = "x - 0.5" }
transitions = [
    { mode = "free", event = "touch", next = "contact" },
    { mode = "contact", event = "loss", next = "free" },
]
initial.mode = "free"
)toml",
                                    "hertz.toml"));
    for (const std::vector<double>& state : {std::vector{0.0, 0.0}, std::vector{0.3, 1.0}, std::vector{0.6, 1.0},
                                             std::vector{0.6, -1.0}, std::vector{0.45, 1.0}})
        for (const DerivativeFinding& finding : check_derivatives(system, state, system.model().parameter_values()))
            ADD_FAILURE() << state[0] << ' ' << state[1] << ' ' << finding.part << ": " << finding.text();
}

TEST(DerivativeCheck, RefusesWhatDoesNotFit) {
    const System system(load_model("bouncing-ball"));
    const std::vector<double> state = system.model().initial_state(), parameters = system.model().parameter_values();
    EXPECT_THROW(check_derivatives(system, {}, parameters), InputError);
    EXPECT_THROW(check_derivatives(system, state, {}), InputError);
    const std::vector<double> unknown(state.size(), std::numeric_limits<double>::quiet_NaN());
    EXPECT_THROW(check_derivatives(system, unknown, parameters), InputError);
}

} // namespace graze::derivative_check_test
