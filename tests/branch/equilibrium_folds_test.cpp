// Folds of equilibria, represented as orbits with an added clock. Velocities are zero, and at the fold displacements do
// not act on them, so the scale of a velocity follows only from its effect on displacements.

#include "maps.hpp"

#include "graze/branch/located_value.hpp"
#include "graze/model/model_file.hpp"
#include "graze/orbit/solve.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace graze::equilibrium_folds_test {

using namespace graze::testing;

/// A plate on a spring attracted across a gap: pull-in at V^2 = 4 k d^3/27.
Model plate(double gap, double stiffness, double time) {
    return OneMode{.parameters = fmt::format("V = {:.17g}\nk = {:.17g}\nd = {:.17g}\nc = {:.17g}",
                                             0.1 * std::sqrt(stiffness * std::pow(gap, 3)), stiffness, gap, 0.3 / time),
                   .states = "q = 0\nv = 0",
                   .rates = "q = 'v', v = '-c*v - k*q + V^2/(d - q)^2'",
                   .clock = fmt::format("{:.17g}", 1 / time)}
        .model();
}

TEST(EquilibriumFolds, AreFollowedInTwoParametersInAnyUnits) {
    for (const double gap : {1.0, 1e-9, 1e6})
        for (const double time : {1.0, 1e-6}) {
            const double stiffness = 1 / (time * time);
            const Model model = plate(gap, stiffness, time);
            const OrbitSolution rest = settled(model, "start", 1000);
            ASSERT_EQ(rest.outcome, OrbitOutcome::converged) << rest.detail;
            const auto pulled_in = [&](double k) { return std::sqrt(4 * k * std::pow(gap, 3) / 27); };
            BranchSettings settings = in_parameter(model, "V", {}, 2 * pulled_in(stiffness));
            settings.stop_at = {PointType::fold};
            const Branch branch = follow_branch(System(model), rest.orbit, settings);
            const auto folds = of_type(branch, PointType::fold);
            ASSERT_EQ(folds.size(), 1U) << branch.detail;
            EXPECT_NEAR(folds[0].parameter / pulled_in(stiffness), 1, 1e-10);
            const BranchSettings along = in_parameter(model, "k", 0.5 * stiffness, 2 * stiffness);
            const Branch curve = curve_of(model, folds[0], along, "V", 0, 4 * pulled_in(stiffness), 1);
            EXPECT_EQ(curve.outcome, BranchOutcome::bound) << gap << ", " << time << ": " << curve.detail;
            for (const BranchPoint& point : curve.points)
                EXPECT_NEAR(value_of(model, point.solution, "V") / pulled_in(point.parameter), 1, 1e-9);
            // The derivatives are exact: V scales with k^(1/2) and d^(3/2), and does not depend on c.
            const LocatedValue located(
                System(model), folds[0], settings.parameter,
                {model.independent_parameter("k"), model.independent_parameter("d"), model.independent_parameter("c")});
            const double value = pulled_in(stiffness);
            EXPECT_NEAR(located.derivatives()[0] * stiffness / value, 0.5, 1e-8);
            EXPECT_NEAR(located.derivatives()[1] * gap / value, 1.5, 1e-8);
            EXPECT_NEAR(located.derivatives()[2] * (0.3 / time) / value, 0, 1e-8);
        }
}

} // namespace graze::equilibrium_folds_test
