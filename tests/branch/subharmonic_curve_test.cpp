// Curves of orbits with one impact in several periods of the force, in closed form.

#include "impact_oscillator.hpp"
#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::subharmonic_curve_test {

using namespace graze::testing;

/// Returns the orbit with half the largest possible speed, on the admissible side.
OrbitSolution start_of(const Oscillator& known, double periods) {
    const double after = -0.5 * known.radius / std::abs(known.k) * std::abs(known.b);
    OrbitSolution solution;
    for (const bool upper : {true, false}) {
        const double sigma = known.sigma(after, upper);
        const Model model = oscillator_model(known, sigma);
        const Orbit orbit = given_orbit(model, "impact", {{sigma, after, known.phase(after, sigma)}},
                                        {2 * std::numbers::pi * periods / known.omega});
        solution = solve_orbit(System(model), orbit);
        if (solution.outcome == OrbitOutcome::converged && solution.certificate.admissible)
            return solution;
    }
    ADD_FAILURE() << solution.detail << ", " << solution.certificate.reason;
    return solution;
}

/// Returns the residual of the flip condition divided by the speed, since multipliers grow as it decreases.
double off_flip(const Oscillator& known, double after, double sigma) {
    return (known.trace(after, known.phase(after, sigma), sigma) + 1 + known.product()) * std::abs(after) /
           known.radius;
}

TEST(SubharmonicCurves, FoldsAndFlipsOfSubharmonicsHaveTheirClosedForms) {
    for (const double periods : {2.0, 3.0}) {
        const Oscillator known(2.4 * periods, periods);
        const OrbitSolution start = start_of(known, periods);
        const Model model = oscillator_model(known, 0);
        std::size_t folds = 0, flips = 0;
        for (const int direction : {1, -1}) {
            const BranchSettings settings = in_parameter(model, "sigma", -1, 1, direction);
            const Branch branch = follow_branch(System(model), start.orbit, settings);
            for (const SpecialPoint& point : branch.special) {
                if (point.type != PointType::fold && point.type != PointType::flip)
                    continue;
                ++(point.type == PointType::fold ? folds : flips);
                for (const int way : {1, -1}) {
                    const Branch curve = curve_of(model, point, settings, "omega", 1.8 * periods, 3 * periods, way);
                    EXPECT_GT(curve.points.size(), 3U) << curve.detail;
                    for (const BranchPoint& one : curve.points) {
                        const Oscillator there(value_of(model, one.solution, "omega"), periods);
                        const double after = one.solution.orbit.starts[0][1], sigma = one.parameter;
                        EXPECT_NEAR(std::min(std::abs(there.sigma(after, true) - sigma),
                                             std::abs(there.sigma(after, false) - sigma)),
                                    0, 1e-10 * there.radius);
                        if (point.type == PointType::fold) {
                            EXPECT_NEAR(std::abs(sigma), there.fold(true), 1e-10 * there.radius);
                        } else if (std::abs(after) > 1e-3 * there.radius) {
                            EXPECT_NEAR(off_flip(there, after, sigma), 0, 1e-9);
                        }
                        EXPECT_NEAR(one.solution.orbit.return_time(), 2 * std::numbers::pi * periods / there.omega,
                                    1e-12);
                    }
                }
            }
        }
        EXPECT_GE(folds, 1U) << periods;
        EXPECT_GE(flips, 1U) << periods;
    }
}

} // namespace graze::subharmonic_curve_test
