#include "graze/flow/derivative_check.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

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

TEST(DerivativeCheck, RefusesWhatDoesNotFit) {
    const System system(load_model("bouncing-ball"));
    const std::vector<double> state = system.model().initial_state(), parameters = system.model().parameter_values();
    EXPECT_THROW(check_derivatives(system, {}, parameters), InputError);
    EXPECT_THROW(check_derivatives(system, state, {}), InputError);
    const std::vector<double> unknown(state.size(), std::numeric_limits<double>::quiet_NaN());
    EXPECT_THROW(check_derivatives(system, unknown, parameters), InputError);
}

} // namespace graze::derivative_check_test
