// Single equilibria: Newton's method, eigenvalues, certificates, and what prevents them.

#include "orbit/solve_equilibrium.hpp"

#include "orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace graze::solve_equilibrium_test {

using namespace graze::testing;

OrbitSolution solved(const Model& model) {
    return solve_orbit(System(model),
                       orbit_of_rest(model.initial_mode, model.initial_state(), model.parameter_values()));
}

TEST(SolveEquilibrium, HasTheEigenvaluesOfADampedOscillatorInAnyUnits) {
    for (const double length : {1e-9, 1.0, 1e6})
        for (const double time : {1e-6, 1.0, 1e3}) {
            const Model model = OneMode{.parameters = fmt::format("w = {:.17g}\nz = 0.1\nF = {:.17g}", 1 / time,
                                                                  0.7 * length / (time * time)),
                                        .states = fmt::format("x = {:.17g}\nv = 0", 3 * length),
                                        .rates = "x = 'v', v = 'F - 2*z*w*v - w^2*x'"}
                                    .model();
            const OrbitSolution solution = solved(model);
            ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
            EXPECT_NEAR(solution.orbit.starts[0][0] / length, 0.7, 1e-14);
            EXPECT_EQ(solution.orbit.period(), 0);
            ASSERT_EQ(solution.eigenvalues.size(), 2U);
            EXPECT_NEAR(solution.eigenvalues[0].real() * time, -0.1, 1e-14);
            EXPECT_NEAR(solution.eigenvalues[0].imag() * time, std::sqrt(1 - 0.01), 1e-14);
            EXPECT_TRUE(is_stable(solution));
            EXPECT_LT(solution.error.value(), 1e-13);
        }
}

TEST(SolveEquilibrium, BeyondABarrierIsInadmissible) {
    const OneMode stop{.parameters = "F = 1",
                       .states = "x = 0.1\nv = 0",
                       .rates = "x = 'v', v = 'F - v - x'",
                       .stops = {{"stop", "0.5 - x", "v = '-v'", "J"}}};
    const OrbitSolution beyond = solved(stop.model());
    EXPECT_EQ(beyond.outcome, OrbitOutcome::converged);
    EXPECT_FALSE(beyond.certificate.admissible);
    EXPECT_EQ(beyond.certificate.reason, "the equilibrium lies beyond 'stop'");
    Model before = stop.model();
    before.set_parameter("F", 0.4);
    EXPECT_TRUE(solved(before).certificate.admissible);
}

TEST(SolveEquilibrium, IsNoneWhereAClockActs) {
    const Model driven =
        OneMode{.parameters = "F = 1", .states = "x = 0", .rates = "x = 'F*cos(theta) - x'", .clock = "1"}.model();
    const OrbitSolution solution = solved(driven);
    EXPECT_EQ(solution.outcome, OrbitOutcome::undefined);
    EXPECT_EQ(solution.detail, "the clock 'theta' acts on mode 'free': a motion at rest is an orbit of its period");
    Model still = driven;
    still.set_parameter("F", 0);
    EXPECT_EQ(solved(still).outcome, OrbitOutcome::converged);
}

TEST(SolveEquilibrium, OfAFamilyIsTheNearestAndSaysSo) {
    const Model model =
        OneMode{.parameters = "a = 1", .states = "x = 3\ny = 0.5", .rates = "x = 'y', y = '-a*y'"}.model();
    const OrbitSolution solution = solved(model);
    ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
    EXPECT_EQ(solution.orbit.starts[0][1], 0);
    EXPECT_FALSE(is_stable(solution));
    EXPECT_NE(solution.detail.find("family"), std::string::npos) << solution.detail;
}

TEST(SolveEquilibrium, ThatDoesNotExistIsNotConverged) {
    const Model model = OneMode{.parameters = "a = 1", .states = "x = 0.3", .rates = "x = 'a + x^2'"}.model();
    EXPECT_EQ(solved(model).outcome, OrbitOutcome::not_converged);
}

TEST(SolveEquilibrium, IsFoundFromStatesOfAnotherSize) {
    for (const double start : {1.0, 1e10, -1e6, 1e-20}) {
        const Model model = OneMode{.parameters = "p = 5e-13",
                                    .states = fmt::format("x = {:.17g}\ny = {:.17g}", start, start),
                                    .rates = "x = 'p - x', y = 'x/p - y'"}
                                .model();
        const OrbitSolution solution = solved(model);
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
        EXPECT_NEAR(solution.orbit.starts[0][0] / 5e-13, 1, 1e-12) << start;
        EXPECT_NEAR(solution.orbit.starts[0][1], 1, 1e-12) << start;
        EXPECT_EQ(solution.detail, "");
    }
}

TEST(SolveEquilibrium, IsWhereAMotionSettles) {
    const Model model = OneMode{.parameters = "F = 1",
                                .states = "x = 0.1\nv = 0",
                                .rates = "x = 'v', v = 'F - v - x'",
                                .more = section("s", "v")}
                            .model();
    const OrbitSolution solution = settled(model, "s");
    EXPECT_TRUE(is_rest(solution.orbit.signature));
    EXPECT_NEAR(solution.orbit.starts[0][0], 1, 1e-15);
}

TEST(SolveEquilibrium, HasASignatureThatIsReadBack) {
    const Model model = OneMode{.parameters = "F = 1", .states = "x = 0.1", .rates = "x = 'F - x'"}.model();
    const Signature signature = parse_signature(model, "equilibrium");
    EXPECT_TRUE(is_rest(signature));
    EXPECT_EQ(to_string(model, signature), "equilibrium");
    EXPECT_EQ(parse_signature(model, "free:equilibrium"), signature);
    EXPECT_ANY_THROW(parse_signature(model, "equilibrium^2"));
}

} // namespace graze::solve_equilibrium_test
