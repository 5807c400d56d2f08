// Multipliers of strongly contracting orbits against closed forms.

#include "graze/model/model_file.hpp"
#include "graze/orbit/solve.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace graze {
namespace {

using std::numbers::pi;

/// x' = c' + A (x - c) about a motion c = (cos, sin): multipliers exp(2 pi a) for eigenvalues a of A.
Model relaxation(double fast, double slow, double skew) {
    // A = S diag(-fast, -slow) S^-1 with S = (1, skew; 0.3, 1)
    const double d = 1 - 0.3 * skew;
    const double a = (-fast + 0.3 * skew * slow) / d, b = skew * (fast - slow) / d, c = 0.3 * (slow - fast) / d,
                 e = (0.3 * skew * fast - slow) / d;
    return parse_model(fmt::format(R"toml(
[states]
x = 1
y = 0
theta = {{ initial = 0, period = "2*pi" }}
[definitions]
u = "x - cos(theta)"
w = "y - sin(theta)"
[modes.only]
rates = {{ x = "-sin(theta) + ({:.17g})*u + ({:.17g})*w", y = "cos(theta) + ({:.17g})*u + ({:.17g})*w", theta = 1 }}
[sections.start]
state = "theta"
value = 0
)toml",
                                   a, b, c, e),
                       "relaxation.toml");
}

TEST(Multipliers, StiffRelaxationHasItsClosedForm) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> skew(-1, 1), slow(0.01, 1), exponent(5, 600);
    for (int trial = 0; trial < 20; ++trial) {
        const double fast = exponent(random) / (2 * pi), rest = slow(random);
        const Model model = relaxation(fast, rest, skew(random));
        const Orbit orbit{parse_signature(model, "start"), {}, {{1, 0, 0}}, {2 * pi}, {}};
        const OrbitSolution solution = solve_orbit(System(model), orbit);
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
    const Orbit orbit{parse_signature(model, "start"), {}, {{1, 0, 0}}, {2 * pi}, {}};
    const OrbitSolution solution = solve_orbit(System(model), orbit);
    ASSERT_EQ(solution.multipliers.size(), 2U);
    EXPECT_NEAR(solution.multipliers[0].real(), std::exp(-0.2 * pi), 1e-10);
    EXPECT_EQ(std::abs(solution.multipliers[1]), 0);
}

TEST(Multipliers, RelaxationOscillatorContractsByItsDivergence) {
    // Van der Pol: the multiplier is exp of the integral of the divergence, which an additional state integrates.
    for (const double mu : {3.0, 8.0, 15.0}) {
        const Model model = parse_model(fmt::format(R"toml(
[parameters]
mu = {:.17g}
[states]
x = 2
v = 0
z = {{ initial = 0, drifting = true }}
[modes.only]
rates = {{ x = "v", v = "mu*(1 - x^2)*v - x", z = "mu*(1 - x^2)" }}
[sections.turn]
function = "v"
direction = "falling"
)toml",
                                                    mu),
                                        "vdp.toml");
        AttractorOptions settle;
        settle.section = "turn";
        const OrbitSolution solution = find_orbit(System(model), settle);
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
        const Simulation simulation{System(model)};
        ASSERT_EQ(solution.multipliers.size(), 1U);
        Trajectory trajectory(simulation, model.parameter_values());
        trajectory.start(solution.orbit.starts[0], 0, 0, solution.orbit.period());
        JetSet jets(simulation, LaneKind::single);
        run(trajectory, jets);
        const double divergence = trajectory.state()[2] - solution.orbit.starts[0][2];
        EXPECT_NEAR(std::log(std::abs(solution.multipliers[0])) / divergence, 1, 1e-8) << mu;
    }
}

} // namespace
} // namespace graze
