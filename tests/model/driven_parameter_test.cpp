// Parameters that change in time: the equations of the driven model, and motions in closed form.

#include "graze/model/driven_parameter.hpp"

#include "evaluate_model.hpp"
#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::driven_parameter_test {

using testing::evaluate;

Model pushed() {
    return parse_model(R"toml(
parameters = { p = 2, twice = "2*p", q = 5 }
states = { x = "p", theta = { initial = 0, period = "q" } }
definitions = { force = "twice + p*x" }
modes.only = { rates = { x = "force", theta = 1 }, watch = ["wall"] }
events = { wall = "q*p - x" }
jumps.back.x = "x - p"
transitions = [{ mode = "only", event = "wall", jump = "back", next = "only" }]
sections.start = { state = "theta", value = 0 }
)toml",
                       "pushed.toml");
}

TEST(DrivenParameter, ReplacesTheParameterInAllEquationsOfMotion) {
    DrivenParameter driven = drive_parameter(pushed(), "p", DriveKind::shift);
    EXPECT_EQ(driven.state, "p_shift");
    EXPECT_EQ(driven.rate, "p_rate");
    Model& model = driven.model;
    model.set_parameter("p_rate", 0.25);
    const std::vector<double> at{3, 1, 0.5}; // x, theta, shift: p is 2.5
    const std::vector<double> rates = evaluate(model, model.expand(model.modes[0].rates), at);
    EXPECT_EQ(rates, (std::vector<double>{5 + 2.5 * 3, 1, 0.25}));
    EXPECT_EQ(evaluate(model, model.expand(model.events[0].function), at), 5 * 2.5 - 3);
    EXPECT_EQ(evaluate(model, model.expand(model.jumps[1].map[0]), at), 0.5);
    EXPECT_EQ(evaluate(model, model.expand(model.jumps[1].map[2]), at), 0.5);
    EXPECT_EQ(evaluate(model, model.expand(driven.value), at), 2.5);
    EXPECT_EQ(model.initial_state(), (std::vector<double>{2, 0, 0}));
    // Quantities and texts that users wrote for the original model.
    Model known = pushed();
    EXPECT_EQ(evaluate(model, driven.of(known.symbol("force") + known.symbol("twice")), at), 5 + 2.5 * 3 + 5);
    EXPECT_THROW(driven.of(known.symbol("p_shift")), InputError);
}

TEST(DrivenParameter, WaveAddsASineOfThePhase) {
    DrivenParameter driven = drive_parameter(pushed(), "p", DriveKind::wave);
    Model& model = driven.model;
    model.set_parameter(driven.amplitude, 0.5);
    model.set_parameter(driven.rate, 3);
    const double phase = 0.7, p = 2 + 0.5 * std::sin(phase);
    const std::vector<double> rates =
        evaluate(model, model.expand(model.modes[0].rates), std::vector<double>{3, 1, phase});
    EXPECT_DOUBLE_EQ(rates[0], 2 * p + p * 3);
    EXPECT_EQ(rates[2], 3);
    EXPECT_NEAR(model.periods()[2], 2 * std::numbers::pi, 1e-15);
}

TEST(DrivenParameter, IsRefusedWhereAConstantDependsOnTheParameter) {
    EXPECT_THROW(drive_parameter(pushed(), "q", DriveKind::shift), InputError);
    EXPECT_THROW(drive_parameter(pushed(), "twice", DriveKind::shift), InputError);
    EXPECT_THROW(drive_parameter(pushed(), "none", DriveKind::wave), InputError);
}

TEST(DrivenParameter, CanBeMadeOfEveryShippedModel) {
    for (const std::string& name : shipped_models()) {
        const Model model = load_model(name);
        for (const std::string& parameter : model.independent_parameters())
            for (const DriveKind kind : {DriveKind::shift, DriveKind::wave})
                try {
                    const DrivenParameter driven = drive_parameter(model, parameter, kind);
                    EXPECT_EQ(driven.model.states.size(), model.states.size() + 1);
                } catch (const InputError& error) {
                    EXPECT_NE(error.problem().find("cannot change in time"), std::string::npos)
                        << name << ' ' << parameter << ": " << error.problem();
                }
    }
}

} // namespace graze::driven_parameter_test
