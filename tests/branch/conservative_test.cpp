// Families of orbits of conservative models, followed as branches with a free damping that stays zero; and parameters
// that pass through zero.

#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace graze::conservative_test {

using namespace graze::testing;
using std::numbers::pi;

/// Returns the period of a pendulum (length 1, gravity 1) with an amplitude, by the arithmetic-geometric mean of 1 and
/// cos(amplitude / 2) (C. F. Gauss).
double pendulum_period(double amplitude) {
    double a = 1, b = std::cos(amplitude / 2);
    for (int i = 0; i < 8; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return 2 * pi / a;
}

/// A pendulum in units of time and angle of its own.
Model pendulum(double time, double angle) {
    return OneMode{.parameters = fmt::format("damping = 0\nT = {:.17g}\nA = {:.17g}", time, angle),
                   .states = "phi = '1*A'\nw = 0",
                   .rates = "phi = 'w', w = '-damping*w - A/T^2*sin(phi/A)'",
                   .more = section("turn", "w", "falling")}
        .model();
}

TEST(Conservative, PendulumFamilyReachesTheTopInAnyUnits) {
    for (const auto& [time, angle] : {std::pair{1.0, 1.0}, {1e-9, 1e-6}, {1e6, 1e9}, {1e-3, 1e9}}) {
        const Model model = pendulum(time, angle);
        const Orbit start = given_orbit(model, "turn", {{0.5 * angle, 0}}, {pendulum_period(0.5) * time});
        BranchSettings settings = in_parameter(model, "damping");
        settings.steps = 400;
        settings.monitors = {
            {"reach", "", Monitor::Kind::maximum, model.symbol("phi"), "", false, {}, {}, {}, 3.0 * angle}};
        std::size_t reached = 0, at_rest = 0;
        for (const int direction : {1, -1}) {
            settings.direction = direction;
            const Branch branch = follow_branch(System(model), start, settings);
            ASSERT_GT(branch.points.size(), 10U) << name_of(branch.outcome) << ' ' << branch.detail << ' ' << time;
            for (const BranchPoint& point : branch.points) {
                const double amplitude = point.solution.orbit.starts[0][0] / angle;
                EXPECT_NEAR(point.solution.orbit.period() / time, pendulum_period(amplitude),
                            1e-9 * pendulum_period(amplitude));
                EXPECT_LT(std::abs(point.parameter * time), 1e-11);
            }
            EXPECT_TRUE(of_type(branch, PointType::fold).empty()) << names(branch);
            EXPECT_TRUE(of_type(branch, PointType::torus).empty()) << names(branch);
            reached += of_type(branch, PointType::bound).size();
            for (const SpecialPoint& rest : of_type(branch, PointType::hopf)) {
                ++at_rest;
                EXPECT_EQ(branch.outcome, BranchOutcome::shrunk);
                EXPECT_LT(std::abs(rest.solution.orbit.starts[0][0] / angle), 1e-9);
            }
        }
        EXPECT_EQ(reached, 1U);
        EXPECT_EQ(at_rest, 1U); // where the branch would continue on the other side
    }
}

/// x'' = acceleration, with sections at its maxima.
Model free_oscillator(const std::string& parameters, const std::string& initial, const std::string& acceleration) {
    return OneMode{.parameters = "damping = 0\n" + parameters,
                   .states = fmt::format("x = '{}'\nv = 0", initial),
                   .rates = fmt::format("x = 'v', v = '-damping*v {}'", acceleration),
                   .more = section("turn", "v", "falling")}
        .model();
}

/// Duffing's oscillator x'' = -x - x^3 - damping x', in units of its own.
Model duffing(double time, double length) {
    return free_oscillator(fmt::format("T = {:.17g}\nA = {:.17g}\npush = 0", time, length), "A",
                           "- (x + x^3/A^2)/T^2 + push*A/T^2");
}

/// Returns the period of x'' + x + x^3 = push for an oscillation with maximum x = 1. With x = c + r cos(angle) between
/// the turning points the integrand is smooth and periodic, so the trapezoidal sum converges exponentially.
double duffing_period(double push) {
    // Half of the squared speed is (1 - x) q(x), and m the zero of q.
    const auto q = [&](double x) { return 0.5 * (1 + x) + 0.25 * (1 + x) * (1 + x * x) - push; };
    double m = -1;
    for (int i = 0; i < 50; ++i)
        m -= q(m) / (0.5 + 0.25 * (1 + 2 * m + 3 * m * m));
    double sum = 0;
    constexpr int parts = 200;
    for (int i = 0; i < parts; ++i) {
        const double x = 0.5 * (1 + m) + 0.5 * (1 - m) * std::cos(pi * (i + 0.5) / parts);
        // q(x) / (x - m), q being a cubic.
        sum += 1 / std::sqrt(2 * (0.75 + 0.25 * (x + m + x * x + x * m + m * m)));
    }
    return 2 * pi * sum / parts;
}

TEST(Conservative, DampingStaysZeroWithFixedAmplitudeWhileThePushPassesZero) {
    for (const auto& [time, length] : {std::pair{1.0, 1.0}, {1e-9, 1e-9}, {1e6, 1e3}}) {
        const Model model = duffing(time, length);
        // Energy h = x^2/2 + x^4/4 at x = 1 gives the period; Newton's method finds it from near.
        const Orbit start = given_orbit(model, "turn", {{length, 0}}, {4.77 * time});
        BranchSettings settings = in_parameter(model, "push", -0.4, 0.4);
        settings.free = {model.independent_parameter("damping")};
        settings.monitors = {{"reach", "", Monitor::Kind::start, model.symbol("x"), "", true, length, {}, {}, {}}};
        double at_zero = 0;
        for (const int direction : {1, -1}) {
            settings.direction = direction;
            const Branch branch = follow_branch(System(model), start, settings);
            ASSERT_EQ(branch.outcome, BranchOutcome::bound) << branch.detail << ' ' << names(branch);
            EXPECT_EQ(names(branch), direction > 0 ? "EX BD" : "BD");
            for (const SpecialPoint& special : of_type(branch, PointType::extremum)) {
                EXPECT_NEAR(special.solution.orbit.period() / time, duffing_period(special.parameter), 1e-10);
                constexpr double step = 1e-3; // step of fourth-order differences
                const auto rise = [&](double by) {
                    return duffing_period(special.parameter + by) - duffing_period(special.parameter - by);
                };
                EXPECT_NEAR((8 * rise(step) - rise(2 * step)) / (12 * step), 0, 1e-9) << special.parameter;
            }
            for (const BranchPoint& point : branch.points) {
                EXPECT_NEAR(point.solution.orbit.period() / time, duffing_period(point.parameter), 1e-10);
                EXPECT_LT(std::abs(point.solution.orbit.parameters[settings.free[0].place()] * time), 1e-11);
                EXPECT_NEAR(point.solution.orbit.starts[0][0], length, 1e-11 * length);
            }
            // From the one end to the other, across zero.
            Orbit end = branch.points.back().solution.orbit;
            BranchSettings back = settings;
            back.direction = -direction;
            const Branch across = follow_branch(System(model), end, back);
            EXPECT_EQ(across.outcome, BranchOutcome::bound) << across.detail;
            EXPECT_EQ(across.points.back().parameter, -0.4 * direction);
            at_zero = branch.points.front().solution.orbit.period() / time;
            EXPECT_NEAR(at_zero, 4.768022, 1e-5);
        }
    }
}

/// Returns the period of x'' + x - 0.2 x^3 + 0.02 x^5 = 0 with an amplitude, by the substitution x = amplitude
/// sin(angle).
double quintic_period(double amplitude) {
    double sum = 0;
    constexpr int parts = 400;
    for (int i = 0; i < parts; ++i) {
        const double a = amplitude * amplitude, x = std::pow(amplitude * std::sin(2 * pi * i / parts), 2);
        sum += 1 / std::sqrt(1 - 0.1 * (a + x) + 0.02 / 3 * (a * a + a * x + x * x));
    }
    return 2 * pi * sum / parts;
}

TEST(Conservative, LongestPeriodOfAFamilyIsFoundAtConstantParameters) {
    const Model model = free_oscillator("", "1", "- x + 0.2*x^3 - 0.02*x^5");
    const Orbit start = given_orbit(model, "turn", {{1, 0}}, {quintic_period(1)});
    BranchSettings settings = in_parameter(model, "damping");
    settings.steps = 400;
    settings.monitors = {{"reach", "", Monitor::Kind::start, model.symbol("x"), "", false, {}, {}, {}, 5}};
    std::size_t found = 0;
    for (const int direction : {1, -1}) {
        settings.direction = direction;
        for (const SpecialPoint& special :
             of_type(follow_branch(System(model), start, settings), PointType::extremum)) {
            const double amplitude = std::abs(special.solution.orbit.starts[0][0]);
            if (amplitude < 1e-6) { // at rest, where one side becomes the other: the shortest period
                EXPECT_NEAR(special.solution.orbit.period(), 2 * pi, 1e-12);
                continue;
            }
            EXPECT_NEAR(amplitude, 2.433356, 1e-5);
            EXPECT_NEAR(special.solution.orbit.period(), quintic_period(amplitude), 1e-9);
            EXPECT_NEAR(special.solution.orbit.period(), 8.495414580788, 1e-9);
            ++found;
        }
    }
    EXPECT_GE(found, 1U); // the other direction leads through the state of rest to the same orbit
}

TEST(Conservative, ForcedOscillatorWithoutDampingHasNoTorusPoints) {
    const Model model =
        driven("damping = 0\nomega = 3\nforce = 0.3", "-damping*v - x - x^3 + force*cos(theta)", "omega");
    const Orbit start = given_orbit(model, "start", {{0.3 / (1 - 9), 0, 0}}, {2 * pi / 3});
    const BranchSettings settings = in_parameter(model, "force", -0.5, 0.5, -1);
    const Branch branch = follow_branch(System(model), start, settings);
    EXPECT_EQ(names(branch), "BD") << branch.detail;
    ASSERT_FALSE(branch.points.empty());
    EXPECT_EQ(branch.points.back().parameter, -0.5);
    // Both ends give the same points.
    EXPECT_NEAR(branch.points.front().solution.orbit.starts[0][0], 0.3 / (1 - 9), 1e-3);
}

TEST(Conservative, CurvesOfAreaPreservingMapsHaveNoResonances) {
    // x -> p - y - q x^2, y -> x, with multipliers of product 1: at the fixed point q x^2 + 2 x = p both are 1 where p
    // q = -1 and -1 where p q = 3.
    const Model model = map_model("p = 1.3\nq = 1", {"p - y - q*x^2", "x"});
    const double x = std::sqrt(2.3) - 1;
    const Orbit orbit = fixed_point(model, {x, x});
    BranchSettings settings = in_parameter(model, "p", -3, 6);
    const Branch up = follow_branch(System(model), orbit, settings);
    settings.direction = -1;
    const Branch down = follow_branch(System(model), orbit, settings);
    const auto flips = of_type(up, PointType::flip), folds = of_type(down, PointType::fold);
    ASSERT_EQ(flips.size(), 1U) << names(up);
    ASSERT_GE(folds.size(), 1U) << names(down);
    EXPECT_NEAR(flips[0].parameter, 3, 1e-9);
    EXPECT_NEAR(folds[0].parameter, -1, 1e-9);
    EXPECT_EQ(flips[0].detail, "c has no value: two multipliers are -1");
    EXPECT_NE(folds[0].detail.find("a has no value: two multipliers are 1"), std::string::npos) << folds[0].detail;
    for (const auto& [point, product] : {std::pair{flips[0], 3.0}, {folds[0], -1.0}})
        for (const int way : {1, -1}) {
            const Branch curve = curve_of(model, point, in_parameter(model, "p", -5, 9), "q", 0.3, 3, way);
            EXPECT_EQ(names(curve), "BD") << short_name(point.type) << ' ' << curve.detail;
            for (const BranchPoint& one : curve.points)
                EXPECT_NEAR(one.solution.orbit.parameters[0] * one.solution.orbit.parameters[1], product, 1e-9);
        }
}

TEST(Conservative, FreeBodyInASymmetricBoxHasNoSymmetryBreaking) {
    // Its position is neutral: the half map has the multiplier -1 for every box.
    const Model model = driven("b = 1", "0.5*cos(theta) - 0.05*v", "1",
                               {{"right", "b - x", "v = '-0.35*v'", "R"}, {"left", "b + x", "v = '-0.35*v'", "L"}},
                               "[symmetries.turn]\nmap = { x = '-x', v = '-v', theta = 'theta + pi' }");
    const std::complex<double> i(0, 1), v = 0.5 / (0.05 + i), x = v / i;
    const Orbit half{parse_signature(model, "start"), model.parameter_values(), {{x.real(), v.real(), 0}}, {pi}, 0};
    const Branch branch = follow_branch(System(model), half, in_parameter(model, "b", 0.6, 30));
    EXPECT_GT(branch.points.size(), 10U) << branch.detail;
    EXPECT_EQ(names(branch), "BD") << branch.detail;
}

} // namespace graze::conservative_test
