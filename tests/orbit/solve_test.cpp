#include "graze/base/input_error.hpp"
#include "orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace graze::solve_test {

using namespace graze::testing;

using std::numbers::pi;

/// One impact per n periods of the force of a linear impact oscillator x'' + 2 zeta x' + x = cos(omega t), in closed
/// form (Shaw and Holmes 1983): the free motion from the stop and back is linear in the impact velocity and in the
/// force's phase, which the two conditions x = sigma and v_after = -e v_before determine.
struct OneImpact {
    double speed = 0, phase = 0; ///< velocity after the impact (negative), phase at it
    bool exists = false;
};
OneImpact one_impact(double zeta, double omega, double sigma, double e, int n, bool upper) {
    const double T = 2 * pi * n / omega, d = std::sqrt(1 - zeta * zeta), decay = std::exp(-zeta * T);
    const double c = std::cos(d * T), s = std::sin(d * T);
    // x = particular + free; particular = A cos(theta) + B sin(theta).
    const double denominator = (1 - omega * omega) * (1 - omega * omega) + 4 * zeta * zeta * omega * omega;
    const double A = (1 - omega * omega) / denominator, B = 2 * zeta * omega / denominator;
    // Free part: y(0) = sigma - p, y'(0) = w - p'; y(T) = sigma - p, y'(T) = -w/e - p' with p, p' of the phase.
    const double m11 = decay * (c + zeta / d * s), m12 = decay * s / d, m21 = -decay * s / d,
                 m22 = decay * (c - zeta / d * s);
    // (1 - m11) y0 = m12 z0 with z0 = w - p'; m21 y0 + m22 z0 = z0 - w (1 + 1/e).
    // y0 = a z0, w = b z0:
    const double a = m12 / (1 - m11), b = (1 - m22 - m21 * a) * e / (1 + e);
    // p' = w - z0 = (b - 1) z0, p = sigma - a z0; p = r cos(phi), p' = -r omega sin(phi), r^2 = A^2 + B^2.
    const double k = (b - 1) / omega, r2 = A * A + B * B;
    // (sigma - a z)^2 + (k z)^2 = r2
    const double qa = a * a + k * k, qb = -2 * sigma * a, qc = sigma * sigma - r2, disc = qb * qb - 4 * qa * qc;
    OneImpact result;
    if (disc < 0)
        return result;
    const double z = (-qb + (upper ? 1 : -1) * std::sqrt(disc)) / (2 * qa);
    result.exists = true;
    result.speed = b * z;
    // p = A cos + B sin, p'/omega = -A sin + B cos
    const double p = sigma - a * z, q = k * z;
    result.phase = std::atan2(B * p - A * q, A * p + B * q);
    return result;
}

TEST(SolveOrbit, LinearImpactOscillatorHasItsClosedForm) {
    const double zeta = 0.05, omega = 2.4, sigma = 0.02, e = 0.7;
    const Model model =
        shipped_with("impact-oscillator", {{"zeta", zeta}, {"omega", omega}, {"sigma", sigma}, {"e", e}});
    std::size_t found = 0;
    for (const int n : {1, 2, 3})
        for (const bool upper : {false, true}) {
            const OneImpact known = one_impact(zeta, omega, sigma, e, n, upper);
            if (!known.exists || known.speed >= 0)
                continue;
            ++found;
            const Orbit guess = given_orbit(model, "impact", {{sigma, known.speed * 1.02, known.phase + 0.02}},
                                            {2 * pi * n / omega * 0.99});
            const OrbitSolution solution = solve_orbit(System(model), guess);
            ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
            EXPECT_NEAR(solution.orbit.starts[0][1], known.speed, 1e-12);
            EXPECT_NEAR(std::remainder(solution.orbit.starts[0][2] - known.phase, 2 * pi), 0, 1e-12);
            EXPECT_NEAR(solution.orbit.period(), 2 * pi * n / omega, 1e-12);
            ASSERT_EQ(solution.multipliers.size(), 2u);
            // Saltation in closed form: trace and determinant.
            const double T = 2 * pi * n / omega, d = std::sqrt(1 - zeta * zeta), decay = std::exp(-zeta * T);
            const double c = std::cos(d * T), s = std::sin(d * T);
            const double v = -known.speed / e;
            const double force = std::cos(known.phase) - sigma;
            const double before = force - 2 * zeta * v, after = force - 2 * zeta * known.speed;
            const double trace = -e * decay * (c + zeta / d * s) - e * decay * (c - zeta / d * s) +
                                 (e * before + after) / v * decay * s / d;
            EXPECT_NEAR((solution.multipliers[0] + solution.multipliers[1]).real(), trace, 1e-10);
            EXPECT_NEAR((solution.multipliers[0] * solution.multipliers[1]).real(), e * e * decay * decay, 1e-11);
            ASSERT_TRUE(solution.error);
            EXPECT_LT(*solution.error, 1e-11);
            EXPECT_NEAR(solution.certificate.approach_speeds[0], v, 1e-12);
        }
    EXPECT_GE(found, 3u);
}

TEST(SolveOrbit, PenetratingOrbitsAreMarkedInadmissible) {
    // The upper solution with three periods per impact crosses the stop in between, although Newton's method converges.
    const Model model =
        shipped_with("impact-oscillator", {{"zeta", 0.05}, {"omega", 2.4}, {"sigma", 0.02}, {"e", 0.7}});
    std::size_t bad = 0;
    for (const int n : {2, 3, 4, 5})
        for (const bool upper : {false, true}) {
            const OneImpact known = one_impact(0.05, 2.4, 0.02, 0.7, n, upper);
            if (!known.exists)
                continue;
            const Orbit guess = given_orbit(model, "impact", {{0.02, known.speed, known.phase}}, {2 * pi * n / 2.4});
            const OrbitSolution solution = solve_orbit(System(model), guess);
            ASSERT_EQ(solution.outcome, OrbitOutcome::converged);
            // The orbit is admissible if and only if simulation from its start first reaches the stop at its end.
            const Simulation simulation{System(model)};
            const FollowedMotion motion = follow_motion(simulation, model.parameter_values(), solution.orbit.starts[0],
                                                        0, solution.orbit.period() * 1.001);
            const bool real = known.speed < 0 && !motion.durations.empty() &&
                              std::abs(motion.durations[0] - solution.orbit.period()) < 1e-6;
            EXPECT_EQ(solution.certificate.admissible, real) << n << upper << solution.certificate.reason;
            bad += real ? 0 : 1;
            if (!real) {
                EXPECT_FALSE(solution.certificate.reason.empty());
            }
        }
    EXPECT_GE(bad, 2u);
}

TEST(FindOrbit, TestbedHasThePublishedMultipliers) {
    Model model = load_model("electromagnetic-testbed");
    model.set_initial("I", 0.1);
    const OrbitSolution solution = settled(model, "phase0", 600);
    ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
    ASSERT_TRUE(solution.orbit.symmetry);
    EXPECT_EQ(to_string(model, solution.orbit.signature), "impact^2");
    EXPECT_NEAR(solution.orbit.period(), 3 / 6.25, 1e-10);
    ASSERT_EQ(solution.multipliers.size(), 3u);
    EXPECT_NEAR(solution.multipliers[0].real(), 0.6128, 5e-5);
    EXPECT_NEAR(solution.multipliers[1].real(), 0.1126, 5e-5);
    EXPECT_TRUE(solution.certificate.admissible) << solution.certificate.reason;
    // Half and whole orbit have the same multipliers.
    const OrbitSolution whole = solve_orbit(System(model), whole_orbit(System(model), solution.orbit));
    ASSERT_EQ(whole.outcome, OrbitOutcome::converged) << whole.detail;
    EXPECT_LE(whole.iterations, 2u);
    EXPECT_NEAR(std::abs(whole.multipliers[0] - solution.multipliers[0]), 0, 1e-8);
}

TEST(FindOrbit, AnOrbitWithoutContactEndsAtTheSection) {
    const Model model = shipped_with("electromagnetic-testbed", {{"V0", 4.5}});
    const OrbitSolution solution = settled(model, "phase0", 150);
    ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
    EXPECT_TRUE(solution.orbit.symmetry);
    EXPECT_EQ(to_string(model, solution.orbit.signature), "phase0");
    const OrbitSolution whole = solve_orbit(System(model), whole_orbit(System(model), solution.orbit));
    ASSERT_EQ(whole.outcome, OrbitOutcome::converged) << whole.detail;
    EXPECT_NEAR(std::abs(whole.multipliers[0] - solution.multipliers[0]), 0, 1e-10);
}

TEST(SolveOrbit, TheFrameOfAMicroactuatorWithoutImpactsIsNeutral) {
    const Model model = shipped_with("impact-microactuator", {{"V", 0.2}});
    const OrbitSolution solution = settled(model, "phase0", 2000);
    ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
    EXPECT_EQ(solution.multipliers.size(), 2u);
    // By Liouville's formula the product of multipliers follows from the damping.
    EXPECT_NEAR(std::abs(solution.multipliers[0] * solution.multipliers[1]), std::exp(-0.04 * pi / 0.9189), 1e-10);
    EXPECT_EQ(to_string(model, parse_signature(model, "{J5}")), "J5");
}

TEST(SolveOrbit, SlowForcingHasTheMultipliersOfTheFreeOscillation) {
    Model model = shipped_with("impact-oscillator", {{"sigma", 0.5}, {"amplitude", 0.1}});
    for (const double omega : {0.05, 0.1, 0.15, 0.2, 0.5}) {
        model.set_parameter("omega", omega);
        const OrbitSolution solution = settled(model, "phase0", 150);
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << omega;
        // Disturbances oscillate freely: the multipliers are the pair exp(-zeta T +- i sqrt(1 - zeta^2) T).
        const double T = 2 * pi / omega, zeta = 0.02;
        ASSERT_EQ(solution.multipliers.size(), 2u) << omega;
        const std::complex<double> exact = std::exp(std::complex<double>(-zeta * T, std::sqrt(1 - zeta * zeta) * T));
        const std::complex<double> upper =
            solution.multipliers[solution.multipliers[0].imag() * exact.imag() > 0 ? 0 : 1];
        EXPECT_NEAR(std::abs(upper - exact), 0, 1e-11 * T) << omega;
        EXPECT_TRUE(is_stable(solution)) << omega;
    }
}

TEST(SolveOrbit, ImpossibleCandidatesAreRefused) {
    const Model model = load_model("impact-oscillator");
    Orbit orbit = given_orbit(model, "impact", {{0.1, -0.5}}, {2});
    EXPECT_THROW(solve_orbit(System(model), orbit), InputError);
    orbit.starts = {{0.1, -0.5, NAN}};
    EXPECT_THROW(solve_orbit(System(model), orbit), InputError);
    orbit.starts = {{0.1, -0.5, 0}, {0.1, -0.5, 0}};
    EXPECT_THROW(solve_orbit(System(model), orbit), InputError);
    orbit.starts = {{0.1, 1e5, 0}};
    orbit.durations = {1e-3};
    const OrbitSolution lost = solve_orbit(System(model), orbit);
    EXPECT_NE(lost.outcome, OrbitOutcome::converged);
    EXPECT_FALSE(lost.detail.empty());
}

TEST(SolveOrbit, ASingleStateThatIsResetHasMultiplierZero) {
    const Model model = integrate_and_fire(2, "barrier");
    const OrbitSolution found = solve_orbit(System(model), given_orbit(model, "fire", {{0.1}}, {0.6}));
    ASSERT_EQ(found.outcome, OrbitOutcome::converged);
    EXPECT_NEAR(found.orbit.period(), std::log(2.0), 1e-13);
    ASSERT_EQ(found.multipliers.size(), 1u);
    EXPECT_EQ(std::abs(found.multipliers.front()), 0);
    EXPECT_TRUE(is_stable(found));
}

/// Friction exceeds the force: slips shrink without end, and no periodic orbit has slips.
TEST(FindOrbit, SlipsBelowRoundOffAreNotPartOfAnOrbit) {
    Model model =
        shipped_with("dry-friction-oscillator", {{"friction_static", 1.05}, {"friction_dynamic", 1.05}, {"omega", 2}});
    model.set_initial("x", 0.2);
    EXPECT_THROW(find_orbit(System(model), {.section = "phase0"}), InputError);
    // Newton's method from two segments of the motion converges to where they vanish.
    const Simulation simulation(System(model), {}, {}, {});
    for (const double left : {1e-4, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9}) {
        const FollowedMotion motion = follow_motion(simulation, model.parameter_values(),
                                                    std::vector{0.05 + left, 0.0, 0.0}, model.initial_mode, 10);
        ASSERT_GE(motion.segments.size(), 4U);
        Orbit candidate;
        candidate.parameters = model.parameter_values();
        for (const std::size_t k : {2, 3}) {
            candidate.signature.push_back(motion.segments[k]);
            candidate.starts.push_back(motion.starts[k]);
            candidate.durations.push_back(motion.durations[k]);
        }
        const OrbitSolution solution = solve_orbit(System(model), candidate);
        EXPECT_FALSE(solution.outcome == OrbitOutcome::converged && solution.certificate.admissible) << left;
    }
    // Where the force exceeds friction by 1 %, the orbit has small slips.
    model.set_parameter("friction_static", 0.99);
    model.set_parameter("friction_dynamic", 0.99);
    const OrbitSolution slips = settled(model, "phase0", 150);
    EXPECT_EQ(slips.outcome, OrbitOutcome::converged) << slips.detail;
    EXPECT_TRUE(slips.certificate.admissible) << slips.certificate.reason;
}

} // namespace graze::solve_test
