#include "branch/locked_orbit_problem.hpp"

#include "locked_circle.hpp"
#include "orbit/eigen_index.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace graze::locked_orbit_problem_test {

using namespace graze::testing;

constexpr double pi = std::numbers::pi;

TEST(LockedOrbitProblem, HasAnOrbitAtEachAngleAtItsOwnParameter) {
    for (const double e : {0.0, 1e-6, 0.05}) {
        const LockedCircle locked(e);
        const auto problem = std::make_shared<LockedOrbitProblem>(locked.setting, 5);
        for (const double turns : {0.0, 0.03, 0.11, 0.17}) {
            const std::vector<double> direction = problem->around_circle(locked.circle, turns, 2);
            std::vector<double> u = problem->on_circle(locked.circle, turns, 2, 0.01);
            entries_of(u) -= 0.01 / problem->length_of(direction) * vector_of(direction);
            Continuation there(problem);
            ASSERT_TRUE(there.start_along(u, direction, 0.01));
            const std::vector<double>& found = there.point().u;
            const double angle = std::atan2(found[1], found[0]);
            EXPECT_NEAR(std::hypot(found[0], found[1]), 1, 1e-13);
            EXPECT_NEAR(found.back(), locked.parameter_at(angle), 1e-13) << e << ' ' << turns;
            EXPECT_NEAR(problem->separation(found), 2 * std::sin(pi / 5), 1e-12);
            const Orbit orbit = problem->orbit();
            EXPECT_EQ(orbit.segments(), 5U);
            EXPECT_NEAR(orbit.starts[2][0], std::cos(angle + 1.6 * pi), 1e-13);
            const std::vector<double> later = problem->later(found, 2);
            EXPECT_EQ(later[0], found[4]);
            EXPECT_EQ(later[9], found[3]);
            EXPECT_EQ(later[10], found[10]);
        }
    }
}

/// At a fold the angle of all five returns advances by 5 * 2 pi / 10 per change of the parameter, and the tangent goes
/// sqrt(5) times as far as each of them.
TEST(LockedOrbitProblem, KnowsHowFastMotionsPassBesideAnOrbit) {
    const LockedCircle locked(0.05);
    LockedOrbitProblem problem(locked.setting, 5);
    const double turns = 0.05; // sin(5 angle) = 1
    const std::vector<double> u = problem.on_circle(locked.circle, turns, 2, locked.parameter_at(2 * pi * turns));
    std::vector<double> tangent = problem.around_circle(locked.circle, turns, 2);
    entries_of(tangent) /= problem.length_of(tangent);
    ASSERT_TRUE(problem.evaluate(u));
    const LockedOrbitProblem::Drift drift = problem.drift(tangent);
    EXPECT_NEAR(drift.along, std::sqrt(5.) * pi, 1e-9);
    EXPECT_EQ(drift.across.back(), 1);
    for (std::size_t i = 0; i < 10; ++i) // the circle stays where it is
        EXPECT_NEAR(drift.across[i], 0, 1e-12);
    // Errors along the circle of all five returns move the parameter by the mean of them in units of 2 pi/10; those of
    // x and y in unknown directions by up to sqrt(2) of it, and those across the circle act by way of e.
    EXPECT_LE(problem.parameter_error(tangent), 10 * std::sqrt(2.) / (2 * pi) * 1.05);
    EXPECT_GE(problem.parameter_error(tangent), 10 / (2 * pi) * 0.95);
}

} // namespace graze::locked_orbit_problem_test
