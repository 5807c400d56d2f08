// The shipped oscillator on a belt: grazing-sliding in closed form and as published, adding-sliding by other means.

#include "graze/model/catalogue.hpp"
#include "study/study_fixture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

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

/// An orbit of the period of the force that slips once and touches, while it moves with the belt, the greatest force
/// that friction can balance: there 1 + amplitude nu sin(theta) = 0. Found by Newton's method from the closed form of
/// the motion with the belt and from Runge-Kutta steps for the slip.
class TouchOnTheBelt {
public:
    using Real = long double;
    explicit TouchOnTheBelt(Real nu) : nu_(nu) {}

    /// @param amplitude, slip first guesses of the amplitude and of the time of the slip
    Real amplitude(Real amplitude, Real slip) const {
        constexpr Real small = 1e-6L;
        for (int i = 0; i < 30; ++i) {
            const auto [f, g] = lack(amplitude, slip);
            const auto [fa, ga] = lack(amplitude + small, slip);
            const auto [fs, gs] = lack(amplitude, slip + small);
            const Real a = (fa - f) / small, b = (fs - f) / small, c = (ga - g) / small, d = (gs - g) / small;
            amplitude -= (f * d - g * b) / (a * d - b * c);
            slip -= (a * g - c * f) / (a * d - b * c);
        }
        return amplitude;
    }

private:
    static constexpr Real alpha0 = 1.5L, alpha1 = 1.5L, alpha2 = 0.45L;

    /// Returns by how much the velocity at the end of the slip differs from that of the belt, and the position from
    /// that of the motion with the belt a period later.
    std::pair<Real, Real> lack(Real amplitude, Real slip) const {
        const Real touch = -std::asin(1 / (amplitude * nu_)), x = amplitude * std::cos(touch) - alpha0;
        const auto belt = [&](Real theta) { return x + (theta - touch) / nu_; };
        Real low = touch + 0.1L, high = low; // where the spring pulls the mass off
        const auto left = [&](Real theta) { return amplitude * std::cos(theta) - belt(theta) + alpha0; };
        while (left(high) > 0)
            low = std::exchange(high, high + 0.01L);
        for (int i = 0; i < 80; ++i)
            (left((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
        Real q = belt(low), v = 1;
        const auto force = [&](Real at, Real position, Real velocity) {
            const Real u = 1 - velocity;
            return amplitude * std::cos(low + nu_ * at) - position + alpha0 - alpha1 * u + alpha2 * u * u * u;
        };
        constexpr int steps = 4000;
        const Real h = slip / steps;
        for (int i = 0; i < steps; ++i) {
            const Real t = h * i, a1 = force(t, q, v), v2 = v + h / 2 * a1, a2 = force(t + h / 2, q + h / 2 * v, v2),
                       v3 = v + h / 2 * a2, a3 = force(t + h / 2, q + h / 2 * v2, v3), v4 = v + h * a3,
                       a4 = force(t + h, q + h * v3, v4);
            q += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
            v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
        }
        return {v - 1, q - belt(low + nu_ * slip - 2 * std::numbers::pi_v<Real>)};
    }

    Real nu_;
};

/// Adding-sliding along a branch, and its curve in two parameters.
TEST_F(BeltOscillator, TouchesTheGreatestForceOnTheBelt) {
    expect_complete(run(R"(name = "s"
model = "belt-oscillator"
[runs.branch]
kind = "continue"
set = { nu = 1, amplitude = 1.78 }
along = { amplitude = [1.75, 1.826] }
[runs.curve]
kind = "curve"
start = { run = "branch", point = "GR1" }
along = { nu = [0.7, 1.05], amplitude = [1, 3] }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto touch = file.orbit("branch", std::string("GR1"));
    ASSERT_TRUE(touch);
    EXPECT_THAT(touch->point.detail, HasSubstr("stick-faster; adding-sliding; goes on as stick:faster faster:belt"));
    const Model model = load_model("belt-oscillator");
    // Guesses from the orbits themselves, a hundredth away.
    const auto expect_touch = [&](const Orbit& orbit) {
        const auto value = [&](const char* name) {
            return orbit.parameters[model.independent_parameter(name).place()];
        };
        for (std::size_t s = 0; s < orbit.segments(); ++s)
            if (orbit.signature[s].mode == *model.find_mode("slower")) {
                const auto amplitude =
                    TouchOnTheBelt(value("nu")).amplitude(value("amplitude") + 0.01, orbit.durations[s] + 0.01);
                EXPECT_NEAR(value("amplitude"), static_cast<double>(amplitude), 1e-10) << value("nu");
            }
    };
    expect_touch(touch->point.solution.orbit);
    for (const auto& [label, nu] : {std::pair{"BD1", 1.05}, std::pair{"BD2", 0.7}}) {
        const auto end = file.orbit("curve", std::string(label));
        ASSERT_TRUE(end) << label;
        EXPECT_EQ(end->point.solution.orbit.parameters[model.independent_parameter("nu").place()], nu);
        expect_touch(end->point.solution.orbit);
    }
}

} // namespace graze::belt_oscillator_test
