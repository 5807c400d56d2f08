// Multipliers of strongly contracting orbits against closed forms.

#include "orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace graze::multipliers_test {

using namespace graze::testing;

using std::numbers::pi;

/// x' = c' + A (x - c) about a motion c = (cos, sin): multipliers exp(2 pi a) for eigenvalues a of A.
Model relaxation(double fast, double slow, double skew) {
    // A = S diag(-fast, -slow) S^-1 with S = (1, skew; 0.3, 1)
    const double d = 1 - 0.3 * skew;
    const double a = (-fast + 0.3 * skew * slow) / d, b = skew * (fast - slow) / d, c = 0.3 * (slow - fast) / d,
                 e = (0.3 * skew * fast - slow) / d;
    return OneMode{.states = "x = 1\ny = 0",
                   .definitions = "u = 'x - cos(theta)'\nw = 'y - sin(theta)'",
                   .rates = fmt::format("x = '-sin(theta) + ({:.17g})*u + ({:.17g})*w', "
                                        "y = 'cos(theta) + ({:.17g})*u + ({:.17g})*w'",
                                        a, b, c, e),
                   .clock = "1"}
        .model();
}

TEST(Multipliers, StiffRelaxationHasItsClosedForm) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> skew(-1, 1), slow(0.01, 1), exponent(5, 600);
    for (int trial = 0; trial < 20; ++trial) {
        const double fast = exponent(random) / (2 * pi), rest = slow(random);
        const Model model = relaxation(fast, rest, skew(random));
        const OrbitSolution solution = solve_orbit(System(model), given_orbit(model, "start", {{1, 0, 0}}, {2 * pi}));
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
        ASSERT_EQ(solution.multipliers.size(), 2U);
        std::vector<double> known{-2 * pi * fast, -2 * pi * rest};
        std::sort(known.begin(), known.end());
        // Derivatives are accurate to about 1e-11 in each part, and each factor e^-100 takes about ten parts.
        EXPECT_NEAR(std::log(solution.multipliers[0].real()), known[1], 1e-9);
        EXPECT_NEAR(std::log(solution.multipliers[1].real()), known[0], 1e-8);
    }
}

TEST(Multipliers, ValuesBelowTheSmallestDoubleAreZero) {
    const Model model = relaxation(200, 0.1, 0.5);
    const OrbitSolution solution = solve_orbit(System(model), given_orbit(model, "start", {{1, 0, 0}}, {2 * pi}));
    ASSERT_EQ(solution.multipliers.size(), 2U);
    EXPECT_NEAR(solution.multipliers[0].real(), std::exp(-0.2 * pi), 1e-10);
    EXPECT_EQ(std::abs(solution.multipliers[1]), 0);
}

TEST(Multipliers, RelaxationOscillatorContractsByItsDivergence) {
    // Van der Pol: the multiplier is exp of the integral of the divergence, which an additional state integrates.
    for (const double mu : {3.0, 8.0, 15.0}) {
        const Model model = OneMode{.parameters = fmt::format("mu = {:.17g}", mu),
                                    .states = "x = 2\nv = 0\nz = { initial = 0, drifting = true }",
                                    .rates = "x = 'v', v = 'mu*(1 - x^2)*v - x', z = 'mu*(1 - x^2)'",
                                    .more = section("turn", "v", "falling")}
                                .model();
        const OrbitSolution solution = settled(model, "turn", 150);
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
        ASSERT_EQ(solution.multipliers.size(), 1U);
        Experiment motion(model);
        motion.run_from(solution.orbit.starts[0], 0, solution.orbit.period());
        const double divergence = motion.state()[2] - solution.orbit.starts[0][2];
        EXPECT_NEAR(std::log(std::abs(solution.multipliers[0])) / divergence, 1, 1e-8) << mu;
    }
}

} // namespace graze::multipliers_test
