// Orbits of models that conserve a quantity: one member of the family is found and reported as such.

#include "orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

namespace graze::family_test {

using namespace graze::testing;

using std::numbers::pi;

/// x'' = -x on the right, x'' = -k x on the left, without damping: half a period of each.
Model bilinear() {
    return TwoModes{.parameters = "k = 4\ndamping = 0",
                    .states = "x = 1\nv = 0",
                    .first = {"right", "x = 'v', v = '-x - damping*v'", "in", "x"},
                    .second = {"left", "x = 'v', v = '-k*x - damping*v'", "out", "-x"}}
        .model();
}

TEST(Family, BilinearOscillatorKeepsTheAmplitudeOfTheCandidate) {
    const Model model = bilinear();
    for (const double speed : {1.0, 0.3, 77.0}) {
        const OrbitSolution solution =
            solve_orbit(System(model), given_orbit(model, "in out", {{0, speed}, {0, -speed}}, {pi, pi / 2}));
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
    const Model model =
        OneMode{.parameters = "mu = 1", .states = "x = 1", .rates = "x = 'mu - x^2'", .clock = "1"}.model();
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
    const Model model = OneMode{.parameters = "g = 1",
                                .states = "phi = 1\nw = 0",
                                .rates = "phi = 'w', w = '-g*sin(phi)'",
                                .more = section("turn", "w", "falling")}
                            .model();
    const OrbitSolution solution = solve_orbit(System(model), given_orbit(model, "turn", {{1.0, 0}}, {6.7}));
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
    for (const Case& one : {Case{"x = '1 - x'\nz = '0.5*z + x'", 1, 0.25}, Case{"x = '-x'\nz = '0.3*z + x'", 1, 0.09},
                            Case{"x = 'y'\ny = 'x'\nz = '0.5*z + x'", 2, 0.25}}) {
        const Model model = ticking("x = 0.25\ny = 0.5\nz = 0", "x = 0, y = 0, z = 0", one.map);
        const OrbitSolution solution = settled(model, "half", 150);
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << one.map << solution.detail;
        ASSERT_EQ(solution.multipliers.size(), one.moving + 1) << one.map;
        for (std::size_t m = 0; m < one.moving; ++m)
            EXPECT_NEAR(std::abs(solution.multipliers[m] - 1.0), 0, 1e-12) << one.map;
        EXPECT_NEAR(std::abs(solution.multipliers.back() - one.rest), 0, 1e-12) << one.map;
        EXPECT_FALSE(is_stable(solution));
        EXPECT_NE(solution.detail.find("one of a family"), std::string::npos) << solution.detail;
    }
}

} // namespace graze::family_test
