// The shipped oscillator on a belt: grazing-sliding in closed form and as published.

#include "study/study_fixture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace graze::belt_oscillator_test {

using namespace graze::testing;
using ::testing::HasSubstr;

class BeltOscillator : public StudyFixture {};

/// With linear friction the response to the force reaches the speed 1 of the belt where its amplitude is
/// sqrt((1 - nu^2)^2 + alpha1^2 nu^2)/nu.
TEST_F(BeltOscillator, TouchesTheSpeedOfTheBeltInClosedForm) {
    for (const double nu : {0.7, 1.9}) {
        expect_complete(run(fmt::format(R"(name = "s"
model = "belt-oscillator"
set = {{ alpha0 = 0.4, alpha1 = -0.2, alpha2 = 0, nu = {}, amplitude = 0.1 }}
[runs.free]
kind = "orbit"
cycles = 1000
[runs.branch]
kind = "continue"
start = {{ run = "free" }}
along = {{ amplitude = [0.05, 3] }}
direction = "up"
)",
                                        nu)));
        const ResultFile file(path_, ResultFile::Access::read);
        const auto touch = file.orbit("branch", std::string("GR1"));
        ASSERT_TRUE(touch);
        EXPECT_NEAR(touch->point.parameter, std::hypot(1 - nu * nu, 0.2 * nu) / nu, 1e-11);
        EXPECT_THAT(touch->point.detail, HasSubstr("grazing-sliding"));
    }
}

/// The published grazing-sliding of an orbit of four periods is at nu = 1.7077997; below it is chaos.
TEST_F(BeltOscillator, StartsChaosAtThePublishedFrequency) {
    expect_complete(run(R"(name = "s"
model = "belt-oscillator"
[runs.branch]
kind = "continue"
set = { nu = 1.711 }
along = { nu = [1.7, 1.712] }
[runs.below]
kind = "sweep"
vary = { nu = [1.706] }
lyapunov_cycles = 400
chaos_cycles = 500
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto touch = file.orbit("branch", std::string("GR1"));
    ASSERT_TRUE(touch);
    EXPECT_NEAR(touch->point.parameter, 1.7077997, 5e-8);
    EXPECT_THAT(touch->point.detail, HasSubstr("grazing-sliding"));
    EXPECT_NEAR(touch->point.solution.orbit.period(), 8 * std::numbers::pi / touch->point.parameter, 1e-10);
    EXPECT_EQ(file.point("below", 0)->result.label, Label::chaotic);
}

} // namespace graze::belt_oscillator_test
