// Homoclinic orbits from first guesses: closed forms with several unstable directions, and what is refused.

#include "orbit/solve_homoclinic.hpp"

#include "graze/base/input_error.hpp"
#include "orbit/orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace graze::solve_homoclinic_test {

using namespace graze::testing;

/// (y, z) spiral away from the saddle, x decays; at y = 1 the state jumps to (1, m, z). The spiral through (0, 1, 0) is
/// a homoclinic orbit at m = 0: there are two conditions, on the parameter and on the phase of the spiral.
Model unstable_spiral(double m) {
    return OneMode{.parameters = fmt::format("l = 1.5\na = 0.4\nw = 2\nm = {:.17g}", m),
                   .states = "x = 0\ny = 0.1\nz = 0",
                   .rates = "x = '-l*x', y = 'a*y - w*z', z = 'w*y + a*z'",
                   .stops = {{"gate", "1 - y", "x = 1\ny = 'm + 0.3*z'", "back"}}}
        .model();
}

/// The spiral through (0, 1, 0), from a distance on, and the decay to another distance. @param off of the phase
Orbit guess(const Model& model, double begin, double end, double off) {
    const double before = std::log(1 / begin) / 0.4, phase = 2 * before + off;
    return given_orbit(model, "back saddle",
                       {{0, begin * std::cos(phase), -begin * std::sin(phase)}, {1, 0.001, 0.002}},
                       {before, std::log(1 / end) / 1.5});
}

TEST(SolveHomoclinic, FindsParameterAndPhaseWithTwoUnstableDirections) {
    const Model model = unstable_spiral(0.003);
    for (const auto& [begin, end] : {std::pair(0.02, 0.01), {1e-3, 0.02}, {0.05, 1e-4}}) {
        const HomoclinicSolution found =
            solve_homoclinic(System(model), guess(model, begin, end, 0.01), model.independent_parameter("m"));
        ASSERT_EQ(found.solution.outcome, OrbitOutcome::converged) << found.solution.detail;
        EXPECT_NEAR(found.parameter, 0, 1e-13);
        EXPECT_LT(found.error, 1e-11); // of the parameter, whose effect is of the order of 1
        EXPECT_EQ(found.solution.orbit.parameters[3], found.parameter);
        EXPECT_TRUE(found.solution.certificate.admissible) << found.solution.certificate.reason;
        // Of a linear field the orbit is exact: at the gate z = 0, and beyond it the spiral does not begin again.
        const std::vector<double>& begun = found.solution.orbit.starts[0];
        EXPECT_NEAR(begun[0], 0, 1e-14);
        const double radius = std::hypot(begun[1], begun[2]), before = std::log(1 / radius) / 0.4;
        EXPECT_NEAR(found.solution.orbit.durations[0], before, 1e-8);
        EXPECT_NEAR(begun[1], radius * std::cos(2 * before), 1e-8 * radius);
        EXPECT_NEAR(found.solution.orbit.starts[1][2], 0, 1e-10);
        ASSERT_EQ(found.solution.eigenvalues.size(), 3U);
        EXPECT_LT(std::abs(found.solution.eigenvalues[0] - std::complex(0.4, 2.0)), 1e-13);
        EXPECT_NEAR(found.solution.eigenvalues[2].real(), -1.5, 1e-13);
        EXPECT_FALSE(is_stable(found.solution));
    }
}

TEST(SolveHomoclinic, SolvesForTheParameterThatIsNamed) {
    // The phase and m do not depend on l.
    const Model model = unstable_spiral(0);
    const HomoclinicSolution found =
        solve_homoclinic(System(model), guess(model, 0.02, 0.01, 0.01), model.independent_parameter("l"));
    EXPECT_NE(found.solution.outcome, OrbitOutcome::converged);
    EXPECT_FALSE(found.solution.detail.empty());
}

TEST(SolveHomoclinic, SaysWhereThereIsNoSaddle) {
    const Model model = OneMode{.parameters = "m = 0.1",
                                .states = "x = 1\nv = 0",
                                .rates = "x = 'v', v = '-x - m*v'",
                                .stops = {{"wall", "x", "v = '-v'", "impact"}}}
                            .model();
    const Orbit orbit = given_orbit(model, "impact saddle", {{0.01, 0}, {0, 1}}, {1, 1});
    const HomoclinicSolution found = solve_homoclinic(System(model), orbit, model.independent_parameter("m"));
    EXPECT_EQ(found.solution.outcome, OrbitOutcome::undefined);
    EXPECT_EQ(found.solution.detail, "the equilibrium is stable: it is no saddle");
    EXPECT_THROW(
        solve_homoclinic(System(model), given_orbit(model, "impact", {{0, 1}}, {3}), model.independent_parameter("m")),
        InputError);
    EXPECT_THROW(solve_orbit(System(model), orbit), InputError);
    EXPECT_THROW(orbit_with_signature(System(model), orbit.signature), InputError);
}

} // namespace graze::solve_homoclinic_test
