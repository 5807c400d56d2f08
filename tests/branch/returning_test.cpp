// Branches of doubled or asymmetric orbits between two points of a branch of simpler orbits: they end at the second
// point for any step lengths.

#include "follow.hpp"

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

} // namespace graze::returning_test
