// Branches of smooth systems whose periodic orbits are known in closed form: normal forms for the deviation u from the
// motion x = cos(theta) of a clock.

#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::normal_forms_test {

using namespace graze::testing;
using std::numbers::pi;

/// u' = rate, in the parameter p.
Model in_p(const std::string& rate, double p, double u, const std::string& more = "") {
    return about_clock(fmt::format("p = {:.17g}", p), rate, u, more);
}

Orbit orbit_from(const Model& model, std::vector<double> state) {
    return given_orbit(model, "start", {std::move(state)}, {2 * pi});
}

TEST(NormalForms, ClosedBranchIsFollowedOnce) {
    // Orbits u^2 + p^2 = 1: folds at p = +-1, and the parameter passes zero twice.
    const Model model = in_p("p^2 + u^2 - 1", 0.6, 0.8);
    for (const int direction : {1, -1})
        for (const double first_step : {0.01, 0.1, 0.003}) {
            BranchSettings settings;
            settings.direction = direction;
            settings.continuation.first_step = first_step;
            const Branch branch = follow_branch(System(model), orbit_from(model, {1.8, 0}), settings);
            EXPECT_EQ(branch.outcome, BranchOutcome::closed) << branch.detail;
            ASSERT_EQ(names(branch), "SN SN");
            EXPECT_NEAR(branch.special[0].parameter, direction, 1e-12);
            EXPECT_NEAR(branch.special[1].parameter, -direction, 1e-12);
            for (const SpecialPoint& fold : branch.special) {
                expect_fold(branch, fold);
                EXPECT_NEAR(fold.solution.orbit.starts[0][0], 1, 1e-9);
            }
            for (const BranchPoint& point : branch.points) {
                const double u = point.solution.orbit.starts[0][0] - 1;
                EXPECT_NEAR(u * u + point.parameter * point.parameter, 1, 1e-10);
                EXPECT_NEAR(point.solution.multipliers.at(0).real(), std::exp(4 * pi * u),
                            1e-8 * std::exp(4 * pi * std::abs(u)));
                EXPECT_EQ(point.stable, u < 0);
            }
        }
}

TEST(NormalForms, BranchContinuesThroughTheOrbitAtRest) {
    // A force p cos(theta) on a linear oscillator: at p = 0 the orbit is a point, beyond it the symmetric image.
    const Model model = driven("p = 0.5", "p*cos(theta) - 0.1*v - 4*x");
    BranchSettings settings;
    settings.direction = -1;
    settings.least = -0.5;
    const Branch branch = follow_branch(System(model), settled(model, "start").orbit, settings);
    EXPECT_EQ(names(branch), "BD");
    EXPECT_EQ(branch.points.back().parameter, -0.5);
    EXPECT_NEAR(branch.points.back().solution.orbit.starts[0][0], -branch.points.front().solution.orbit.starts[0][0],
                1e-12);
}

TEST(NormalForms, TranscriticalBranchesCross) {
    // u = 0 and u = p.
    const Model model = in_p("u*(p - u)", -0.5, 0);
    BranchSettings settings;
    settings.greatest = 0.5;
    settings.least = -0.5;
    const Branch branch = follow_branch(System(model), orbit_from(model, {1, 0}), settings);
    ASSERT_EQ(names(branch), "BP BD");
    EXPECT_NEAR(branch.special[0].parameter, 0, 1e-12);
    const auto starts = branches_at(System(model), branch.special[0], settings);
    ASSERT_EQ(starts.size(), 2U);
    for (const BranchStart& start : starts) {
        const Branch other = follow(model, start, settings);
        EXPECT_EQ(names(other), "BD");
        ASSERT_GT(other.points.size(), 3U);
        for (const BranchPoint& point : other.points)
            EXPECT_NEAR(point.solution.orbit.starts[0][0] - 1, point.parameter, 1e-10);
    }
}

TEST(NormalForms, PitchforkIsFoundWithAndWithoutDeclaredSymmetry) {
    // u = 0 and u^2 = p, which are images of each other under x -> -x, theta -> theta + pi.
    const std::string symmetry = "[symmetries.mirror]\nmap = { x = \"-x\", theta = \"theta + pi\" }\n";
    for (const bool declared : {false, true}) {
        const Model model = in_p("u*(p - u^2)", -0.5, 0, declared ? symmetry : "");
        Orbit orbit = orbit_from(model, {1, 0});
        if (declared) {
            orbit = half_orbit(System(model), orbit).value();
            EXPECT_NEAR(orbit.durations[0], pi, 1e-15);
        }
        BranchSettings settings;
        settings.greatest = 0.5;
        const Branch branch = follow_branch(System(model), orbit, settings);
        ASSERT_EQ(names(branch), declared ? "SB BD" : "BP BD");
        EXPECT_NEAR(branch.special[0].parameter, 0, 1e-12);
        EXPECT_LT(nearest_multiplier(branch.special[0].solution, 1), 1e-10);
        const auto starts = branches_at(System(model), branch.special[0], settings);
        ASSERT_EQ(starts.size(), 2U);
        double sides = 0;
        for (const BranchStart& start : starts) {
            const Branch other = follow(model, start, settings);
            EXPECT_EQ(names(other), "BD");
            EXPECT_EQ(other.points.back().parameter, 0.5);
            for (const BranchPoint& point : other.points) {
                const double u = point.solution.orbit.starts[0][0] - std::cos(point.solution.orbit.starts[0][1]);
                EXPECT_NEAR(u * u, point.parameter, 1e-10);
                EXPECT_NEAR(point.solution.orbit.period(), 2 * pi, 1e-12);
                EXPECT_TRUE(point.stable);
                EXPECT_NEAR(point.solution.multipliers.at(0).real(), std::exp(-4 * pi * point.parameter), 1e-9);
            }
            sides += other.points.back().solution.orbit.starts[0][0] > 1 ? 1 : -1;
        }
        EXPECT_EQ(sides, 0);
    }
}

TEST(NormalForms, TorusPointIsFoundWhereAFocusLosesStability) {
    const Model model = torus_model();
    BranchSettings settings;
    settings.greatest = 0.1;
    const Branch branch = follow_branch(System(model), orbit_from(model, {1, 0, 0}), settings);
    ASSERT_EQ(names(branch), "NS BD");
    const SpecialPoint& torus = branch.special[0];
    EXPECT_NEAR(torus.parameter, 0, 1e-13);
    const std::complex<double> turn = std::polar(1.0, 2 * pi * 0.3);
    EXPECT_LT(std::min(std::abs(torus.solution.multipliers[0] - turn), std::abs(torus.solution.multipliers[1] - turn)),
              1e-11);
    EXPECT_THROW(branches_at(System(model), torus, settings), InputError);
    for (const BranchPoint& point : branch.points) {
        EXPECT_NEAR(std::abs(point.solution.multipliers[0]), std::exp(2 * pi * point.parameter), 1e-10);
        EXPECT_EQ(point.stable, point.parameter < 0);
    }
}

/// In a frame that rotates by half the clock's angle u' = u (growth - u^2), v' = -v, so that u changes its sign each
/// period: u = v = 0 has a flip where the growth is zero, and the doubled orbit is u^2 = growth.
Model flipping(const std::string& growth, double p) {
    // Half angles occur in even powers only, so that the equations do not notice that theta is set back.
    return OneMode{.parameters = fmt::format("p = {:.17g}", p),
                   .states = "x = 1\ny = 0",
                   .definitions = fmt::format("a = 'x - cos(theta)'\nb = 'y'\nu = 'a*cos(theta/2) + b*sin(theta/2)'\n"
                                              "v = 'b*cos(theta/2) - a*sin(theta/2)'\ngrow = 'u*({} - u^2)'",
                                              growth),
                   .rates = "x = 'grow*cos(theta/2) + v*sin(theta/2) - b/2 - sin(theta)', "
                            "y = 'grow*sin(theta/2) - v*cos(theta/2) + a/2'",
                   .clock = "1"}
        .model();
}

TEST(NormalForms, DoubledOrbitHasItsClosedForm) {
    const Model model = flipping("p", -0.2);
    BranchSettings settings;
    settings.greatest = 0.3;
    const Branch branch = follow_branch(System(model), orbit_from(model, {1, 0, 0}), settings);
    ASSERT_EQ(names(branch), "PD BD");
    EXPECT_NEAR(branch.special[0].parameter, 0, 1e-12);
    expect_flip(branch.special[0]);
    const auto starts = branches_at(System(model), branch.special[0], settings);
    ASSERT_EQ(starts.size(), 1U);
    const Branch doubled = follow(model, starts[0], settings);
    EXPECT_EQ(names(doubled), "BD");
    ASSERT_GT(doubled.points.size(), 5U);
    for (const BranchPoint& point : doubled.points) {
        EXPECT_NEAR(point.solution.orbit.period(), 4 * pi, 1e-12);
        for (std::size_t k = 0; k < 2; ++k) {
            const auto& start = point.solution.orbit.starts[k];
            const double turned = std::cos(start[2]) > 0 ? 1 : -1;
            EXPECT_GT(turned, 0);
            EXPECT_NEAR(std::pow(start[0] - 1, 2), point.parameter, 1e-10);
            EXPECT_NEAR(start[1], 0, 1e-10);
        }
        EXPECT_NEAR(point.solution.multipliers[0].real(), std::exp(-8 * pi * point.parameter), 1e-9);
    }
}

TEST(NormalForms, PairsOfPointsWithinOneStepAreFound) {
    // u = 0 is unstable only while |p| < 0.001: steps are ten times as long, where they are longer no test is near
    // zero.
    const std::string growth = "(0.000001 - p^2)";
    for (const bool flips : {false, true}) {
        const Model model = flips ? flipping(growth, -0.5) : in_p("u*(" + growth + " - u^2)", -0.5, 0);
        const std::vector<double> start = flips ? std::vector<double>{1, 0, 0} : std::vector<double>{1, 0};
        BranchSettings settings;
        settings.greatest = 0.5;
        settings.continuation.first_step = 0.013; // otherwise a step ends at p = 0
        settings.continuation.largest_step = 0.1;
        const Branch branch = follow_branch(System(model), orbit_from(model, start), settings);
        ASSERT_EQ(names(branch), flips ? "PD PD BD" : "BP BP BD");
        EXPECT_EQ(branch.special[0].step, branch.special[1].step);
        EXPECT_NEAR(branch.special[0].parameter, -0.001, 1e-12);
        EXPECT_NEAR(branch.special[1].parameter, 0.001, 1e-12);
    }
}

/// Van der Pol's oscillator from x = 2, with a section where x is largest.
Model van_der_pol(double mu, double v) {
    return OneMode{.parameters = fmt::format("mu = {}", mu),
                   .states = fmt::format("x = 2\nv = {}", v),
                   .rates = "x = 'v', v = 'mu*(1 - x^2)*v - x'",
                   .more = section("top", "v", "falling")}
        .model();
}

/// A stiff motion that needs half a million explicit steps, since its slow manifold attracts at a rate of 3000.
TEST(NormalFormsSlow, StiffRelaxationOscillationIsFollowed) {
    const Model model = van_der_pol(1000, 0);
    const AttractorOptions options{.section = "top", .longest_return = 4000};
    const OrbitSolution solution = find_orbit(System(model), options);
    ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
    // Dorodnitsyn's expansion, to the terms of order log(mu)/mu.
    const double mu = 1000, first_zero = 2.338107410459767;
    EXPECT_NEAR(solution.orbit.period(), (3 - 2 * std::log(2.0)) * mu + 3 * first_zero / std::cbrt(mu),
                3 * std::log(mu) / mu);
    EXPECT_NEAR(solution.orbit.period(), 1614.4011258083, 1e-9); // from two passages of a simulation
    ASSERT_EQ(solution.multipliers.size(), 1U);
    EXPECT_LT(std::abs(solution.multipliers[0]), 1e-12);
}

TEST(NormalForms, SearchForAnOrbitCanBeInterrupted) {
    const Model model = van_der_pol(1, 0.1);
    const AttractorOptions options{.section = "top"};
    int asked = 0;
    EXPECT_FALSE(find_orbit(System(model), options, {}, {}, [&] { return ++asked == 2; }).has_value());
    EXPECT_EQ(asked, 2);
}

TEST(NormalForms, VanDerPolHasItsPublishedPeriod) {
    const Model model = van_der_pol(1, 0.1);
    const OrbitSolution solution = settled(model, "top");
    EXPECT_NEAR(solution.orbit.period(), 6.66328686, 1e-8);
    // The trivial multiplier 1 is not listed.
    ASSERT_EQ(solution.multipliers.size(), 1U);
    BranchSettings settings;
    settings.least = 0.05;
    settings.greatest = 10;
    for (const int direction : {1, -1}) {
        settings.direction = direction;
        const Branch branch = follow_branch(System(model), solution.orbit, settings);
        EXPECT_EQ(names(branch), "BD");
        for (const BranchPoint& point : branch.points) {
            EXPECT_TRUE(point.stable);
            // For small mu: T = 2 pi (1 + mu^2/16 - 5 mu^4/3072 + ...) (Lindstedt's series, see Andersen and Geer
            // 1982), amplitude 2 + mu^2/96.
            if (point.parameter < 0.3) {
                const double m2 = point.parameter * point.parameter;
                EXPECT_NEAR(point.solution.orbit.period(), 2 * pi * (1 + m2 / 16 - 5 * m2 * m2 / 3072),
                            2 * pi * m2 * m2 * m2 / 500);
                EXPECT_NEAR(point.solution.orbit.starts[0][0], 2 + m2 / 96, m2 * m2 / 100);
            }
        }
    }
    // Published period at mu = 10: 19.0783695 (Krogdahl 1960; Andersen and Geer 1982).
    settings.direction = 1;
    const Branch stiff = follow_branch(System(model), solution.orbit, settings);
    EXPECT_NEAR(stiff.points.back().solution.orbit.period(), 19.07836957, 1e-6);
}

TEST(NormalForms, DuffingHasTheFoldsOfItsResponse) {
    // x'' + d x' + x + x^3 = F cos(w t) in w: two folds of the primary resonance.
    const Model model = driven("w = 0.6\nd = 0.1\nF = 0.3", "F*cos(theta) - d*v - x - x^3", "w", {},
                               "[symmetries.mirror]\nmap = { x = '-x', v = '-v', theta = 'theta + pi' }");
    BranchSettings settings;
    settings.least = 0.5;
    settings.greatest = 2.5;
    const OrbitSolution start = settled(model, "start");
    ASSERT_TRUE(start.orbit.symmetry);
    const Branch half = follow_branch(System(model), start.orbit, settings);
    const Branch whole = follow_branch(System(model), whole_orbit(System(model), start.orbit), settings);
    for (const Branch* branch : {&half, &whole}) {
        ASSERT_EQ(names(*branch), "SN SN BD");
        for (const SpecialPoint& fold : of_type(*branch, PointType::fold))
            expect_fold(*branch, fold);
        for (const BranchPoint& point : branch->points)
            EXPECT_NEAR((point.solution.multipliers[0] * point.solution.multipliers[1]).real(),
                        std::exp(-0.1 * 2 * pi / point.parameter), 1e-10);
    }
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR(half.special[i].parameter, whole.special[i].parameter, 1e-11);
    // Harmonic balance with first and third harmonics is good to some 1e-4 here; the folds by first harmonic alone:
    // ((1 - w^2 + 3/4 A^2)^2 + (d w)^2) A^2 = F^2 with vanishing derivative by A.
    const auto response = [](double w, double A) {
        const double stiffness = 1 - w * w + 0.75 * A * A;
        return (stiffness * stiffness + 0.01 * w * w) * A * A - 0.09;
    };
    const auto slope = [](double w, double A) {
        const double stiffness = 1 - w * w + 0.75 * A * A;
        return 2 * A * (stiffness * stiffness + 0.01 * w * w) + 3 * A * A * A * stiffness;
    };
    for (std::size_t i = 0; i < 2; ++i) {
        double w = half.special[i].parameter, A = i == 0 ? 1.69 : 0.6;
        for (int k = 0; k < 50; ++k) { // Newton's method with differences
            constexpr double h = 1e-6;
            const double r = response(w, A), s = slope(w, A);
            const double rw = (response(w + h, A) - r) / h, ra = (response(w, A + h) - r) / h,
                         sw = (slope(w + h, A) - s) / h, sa = (slope(w, A + h) - s) / h, det = rw * sa - ra * sw;
            w -= (r * sa - ra * s) / det;
            A -= (rw * s - r * sw) / det;
        }
        EXPECT_NEAR(half.special[i].parameter, w, 0.02) << A;
    }
}

} // namespace graze::normal_forms_test
