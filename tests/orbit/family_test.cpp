// Orbits of models that conserve a quantity: one member of the family is found and reported as such.

#include "graze/model/model_file.hpp"
#include "graze/orbit/solve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

namespace graze {
namespace {

using std::numbers::pi;

/// x'' = -x on the right, x'' = -k x on the left, without damping: half a period of each.
constexpr const char* bilinear = R"toml(
[initial]
mode = "right"
[parameters]
k = 4
damping = 0
[states]
x = 1
v = 0
[events.in]
function = "x"
kind = "section"
[events.out]
function = "-x"
kind = "section"
[modes.right]
rates = { x = "v", v = "-x - damping*v" }
watch = ["in"]
[modes.left]
rates = { x = "v", v = "-k*x - damping*v" }
watch = ["out"]
[[transitions]]
mode = "right"
event = "in"
next = "left"
label = "in"
[[transitions]]
mode = "left"
event = "out"
next = "right"
label = "out"
)toml";

Orbit bilinear_orbit(const Model& model, double speed, double k) {
    return {parse_signature(model, "in out"),
            model.parameter_values(),
            {{0, speed}, {0, -speed}},
            {pi, pi / std::sqrt(k)},
            std::nullopt};
}

TEST(Family, BilinearOscillatorKeepsTheAmplitudeOfTheCandidate) {
    const Model model = parse_model(bilinear, "test.toml");
    for (const double speed : {1.0, 0.3, 77.0}) {
        const OrbitSolution solution = solve_orbit(System(model), bilinear_orbit(model, speed, 4));
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
        EXPECT_NE(solution.detail.find("one of a family"), std::string::npos) << solution.detail;
        EXPECT_LT(solution.residual, 1e-13);
        EXPECT_NEAR(solution.orbit.starts[0][1], speed, 1e-12 * speed);
        EXPECT_NEAR(solution.orbit.period(), 1.5 * pi, 1e-12);
        ASSERT_EQ(solution.multipliers.size(), 1U);
        EXPECT_NEAR(std::abs(solution.multipliers[0] - 1.0), 0, 1e-10);
    }
}

/// A model with isolated orbits, two of which meet in a fold.
TEST(Family, IsolatedOrbitsAreNotReportedAsAFamily) {
    const Model model = parse_model(R"toml(
[parameters]
mu = 1
[states]
x = 1
theta = { initial = 0, period = "2*pi" }
[modes.only]
rates = { x = "mu - x^2", theta = 1 }
[sections.start]
state = "theta"
value = 0
)toml",
                                    "test.toml");
    for (const double mu : {1.0, 1e-4, 0.0}) {
        Orbit orbit{parse_signature(model, "start"), {mu}, {{std::sqrt(mu), 0}}, {2 * pi}, std::nullopt};
        const OrbitSolution solution = solve_orbit(System(model), orbit);
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
        EXPECT_EQ(solution.detail, "") << mu;
        EXPECT_NEAR(solution.orbit.starts[0][0], std::sqrt(mu), 1e-12);
    }
}

/// From a candidate that is not an orbit, Newton's method finds a nearby member of the family.
TEST(Family, PendulumHasNearlyTheAmplitudeOfTheCandidate) {
    const Model model = parse_model(R"toml(
[parameters]
g = 1
[states]
phi = 1
w = 0
[modes.swing]
rates = { phi = "w", w = "-g*sin(phi)" }
[sections.turn]
function = "w"
direction = "falling"
)toml",
                                    "test.toml");
    const Orbit orbit{parse_signature(model, "turn"), {1.0}, {{1.0, 0}}, {6.7}, std::nullopt};
    const OrbitSolution solution = solve_orbit(System(model), orbit);
    ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
    EXPECT_NE(solution.detail.find("one of a family"), std::string::npos) << solution.detail;
    EXPECT_NEAR(solution.orbit.starts[0][0], 1, 0.01);
    // The arithmetic-geometric mean of 1 and cos(amplitude / 2) (C. F. Gauss).
    double a = 1, b = std::cos(solution.orbit.starts[0][0] / 2);
    for (int i = 0; i < 8; ++i)
        std::tie(a, b) = std::pair(0.5 * (a + b), std::sqrt(a * b));
    EXPECT_NEAR(solution.orbit.period(), 2 * pi / a, 1e-10);
}

/// A jump at each tick of a clock returns some states after two ticks, whatever they were.
TEST(Family, AStateThatTicksReverseParametrisesAFamily) {
    struct Case {
        const char* map; ///< jump of x, y, z
        std::size_t moving;
        double rest; ///< multiplier of the decaying state over two ticks
    };
    // Where x and y swap, both vary; where only x is reversed, y is constant and acts as a parameter.
    for (const Case& one :
         {Case{"x = \"1 - x\"\nz = \"0.5*z + x\"", 1, 0.25}, Case{"x = \"-x\"\nz = \"0.3*z + x\"", 1, 0.09},
          Case{"x = \"y\"\ny = \"x\"\nz = \"0.5*z + x\"", 2, 0.25}}) {
        const Model model = parse_model(std::string(R"toml(
[states]
x = 0.25
y = 0.5
z = 0
c = 0
[events]
tick = "1 - c"
[modes.only]
rates = { x = 0, y = 0, z = 0, c = 1 }
watch = ["tick"]
[[transitions]]
mode = "only"
event = "tick"
jump = "map"
next = "only"
[sections.half]
function = "c - 0.5"
direction = "rising"
[initial]
mode = "only"
[jumps.map]
c = 0
)toml") + one.map + "\n",
                                        "test.toml");
        AttractorOptions settle;
        settle.section = "half";
        const OrbitSolution solution = find_orbit(System(model), settle);
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << one.map << solution.detail;
        ASSERT_EQ(solution.multipliers.size(), one.moving + 1) << one.map;
        for (std::size_t m = 0; m < one.moving; ++m)
            EXPECT_NEAR(std::abs(solution.multipliers[m] - 1.0), 0, 1e-12) << one.map;
        EXPECT_NEAR(std::abs(solution.multipliers.back() - one.rest), 0, 1e-12) << one.map;
        EXPECT_FALSE(is_stable(solution));
        EXPECT_NE(solution.detail.find("one of a family"), std::string::npos) << solution.detail;
    }
}

} // namespace
} // namespace graze
