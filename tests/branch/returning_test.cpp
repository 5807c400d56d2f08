// Branches of doubled or asymmetric orbits between two points of a branch of simpler orbits: they end at the second
// point for any step lengths.

#include "follow.hpp"
#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::returning_test {

using namespace graze::testing;

/// Duffing's oscillator with a force F, in units of time and length, with a driven state.
Model duffing(double damping, double omega, double time, double length) {
    return OneMode{.parameters = fmt::format("F = 1\nT = {:.17g}\nA = {:.17g}", time, length),
                   .states = "x = '0.1*A'\nv = 0\ns = { initial = 0, drifting = true }",
                   .rates = fmt::format("x = 'v', v = '(-x - x^3/A^2 + F*A*cos(theta))/T^2 - {:.17g}*v/T', "
                                        "s = 'v^2 + x*A/T^2'",
                                        damping),
                   .clock = fmt::format("{:.17g}/T", omega),
                   .more = "[symmetries.mirror]\nmap = { x = '-x', v = '-v', theta = 'theta + pi' }"}
        .model();
}

TEST(ReturningBranches, EndAtTheSecondPointOfTheSimplerBranch) {
    struct Case {
        double damping, omega, time, length;
    };
    for (const Case& one :
         {Case{0.14901456065267, 0.6931211339514, 1, 1}, {0.281, 1.311, 1e-6, 1e3}, {0.2127, 1.35, 1e3, 1e-9}}) {
        const Model model = duffing(one.damping, one.omega, one.time, one.length);
        BranchSettings settings = in_parameter(model, "F", 0.01, 40);
        settings.stop_at = {PointType::asymmetry};
        const Branch symmetric = follow_branch(System(model), settled(model, "start").orbit, settings);
        ASSERT_EQ(symmetric.outcome, BranchOutcome::stopped) << names(symmetric);
        settings.stop_at = {};
        const Branch asymmetric =
            follow(model, branches_at(System(model), symmetric.special.back(), settings).at(0), settings);
        const auto flips = of_type(asymmetric, PointType::flip);
        EXPECT_EQ(asymmetric.outcome, BranchOutcome::returned) << names(asymmetric);
        ASSERT_EQ(flips.size(), 2U) << names(asymmetric);
        for (const double step : {0.02, 0.05, 0.1}) {
            settings.continuation.largest_step = step;
            for (const std::size_t i : {0U, 1U}) {
                const Branch doubled = follow(model, branches_at(System(model), flips[i], settings).at(0), settings);
                EXPECT_EQ(doubled.outcome, BranchOutcome::returned) << doubled.detail << names(doubled);
                ASSERT_FALSE(doubled.special.empty());
                EXPECT_NEAR(doubled.special.back().parameter, flips[1 - i].parameter, 1e-6) << step;
                for (std::size_t k = 1; k + 1 < doubled.points.size(); ++k) {
                    const Orbit& orbit = doubled.points[k].solution.orbit;
                    EXPECT_GT(std::abs(orbit.starts[0][0] - orbit.starts[1][0]), 1e-6 * one.length);
                }
            }
        }
    }
}

/// X -> a X - X^3 + b. Folds of its orbits of period 2 lie at 27 b^2 = 4 (a + 2)^3 and end at its degenerate flip,
/// a = -2/3, b = 16/27. The curve of the equations runs back over itself behind this point.
TEST(ReturningBranches, CurvesOfDoubledOrbitsEndWhereTheyMeetSimplerOnes) {
    const Model model = map_model(fmt::format("a = -0.3\nb = {:.17g}", std::sqrt(0.5)), {"a*x - x^3 + b"});
    const Orbit doubled = given_orbit(model, "map map", {{0.966, 0}, {-0.484, 0}}, {1, 1});
    BranchSettings settings = in_parameter(model, "a", -1.4, 1.9, -1);
    const Branch branch = follow_branch(System(model), doubled, settings);
    const auto folds = of_type(branch, PointType::fold);
    ASSERT_FALSE(folds.empty()) << names(branch);
    EXPECT_NEAR(folds[0].parameter, -0.5, 1e-9);
    constexpr double near = 5e-8; // the end is extrapolated where steps fail before it
    for (const double step : {0.02, 0.05, 0.1, 0.2}) {
        settings.continuation.largest_step = step;
        const Branch down = curve_of(model, folds[0], settings, "b", -1.5, 1.5, -1),
                     up = curve_of(model, folds[0], settings, "b", -1.5, 1.5, 1);
        EXPECT_EQ(down.outcome, BranchOutcome::returned) << step << ' ' << names(down);
        EXPECT_EQ(up.outcome, BranchOutcome::bound) << step << ' ' << names(up);
        ASSERT_FALSE(down.special.empty());
        const SpecialPoint& last = down.special.back();
        EXPECT_EQ(last.type, PointType::branch_point);
        EXPECT_NEAR(last.parameter, -2. / 3, near) << step;
        EXPECT_NEAR(value_of(model, last.solution, "b"), 16. / 27, near) << step;
        EXPECT_TRUE(of_type(down, PointType::cusp).empty());
        EXPECT_TRUE(of_type(down, PointType::extremum).empty());
        for (const BranchPoint& one : down.points)
            EXPECT_GE(one.parameter, -2. / 3 - near);
    }
}

} // namespace graze::returning_test
