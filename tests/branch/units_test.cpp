// A branch does not depend on the units in which its model is written.

#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::units_test {

using namespace graze::testing;

/// An oscillator between two stops, with a driven counter, in units of time and length.
Model between_stops(double time, double length) {
    return OneMode{.parameters = fmt::format("omega = {:.17g}\nT = {:.17g}\nA = {:.17g}", 1.5 / time, time, length),
                   .states = "x = 0\nv = '1.2*A/T'\ns = { initial = 0, drifting = true }",
                   .rates = "x = 'v', v = '(2*A*cos(theta) - x)/T^2 - 0.1*v/T', s = 'v^2/A*T'",
                   .clock = "omega",
                   .stops = {{"right", "A - x", "v = '-0.8*v'", "R"}, {"left", "A + x", "v = '-0.8*v'", "L"}},
                   .more = "[symmetries.mirror]\nmap = { x = '-x', v = '-v', theta = 'theta + pi' }"}
        .model();
}

TEST(Units, BranchDoesNotDependOnUnits) {
    Branch reference;
    for (const auto& [time, length] :
         {std::pair{1.0, 1.0}, {1e-9, 1e-9}, {1e6, 1e6}, {1e-9, 1e6}, {1e6, 1e-12}, {1e-3, 1e-12}}) {
        const Model model = between_stops(time, length);
        const auto found = orbit_with_signature(System(model), parse_signature(model, "R L"));
        ASSERT_TRUE(found);
        ASSERT_EQ(found->outcome, OrbitOutcome::converged) << found->detail;
        ASSERT_TRUE(found->orbit.symmetry) << time << ' ' << length;
        BranchSettings settings = in_parameter(model, "omega", 0.3 / time, 6 / time);
        settings.orbit.tolerance = 1e-13;
        const Branch branch = follow_branch(System(model), found->orbit, settings);
        ASSERT_GT(branch.points.size(), 5U);
        if (reference.points.empty())
            reference = branch;
        EXPECT_EQ(branch.outcome, reference.outcome) << branch.detail;
        ASSERT_EQ(names(branch), names(reference)) << time << ' ' << length;
        for (std::size_t i = 0; i < branch.special.size(); ++i)
            EXPECT_NEAR(branch.special[i].parameter * time / reference.special[i].parameter, 1, 1e-9);
        // The special points and the branches that leave them are the same.
        for (std::size_t i = 0; i < branch.special.size(); ++i) {
            if (branch.special[i].type != PointType::asymmetry && branch.special[i].type != PointType::flip)
                continue;
            settings.steps = 5;
            const Branch other = follow(model, branches_at(System(model), branch.special[i], settings).at(0), settings);
            ASSERT_GT(other.points.size(), 1U) << other.detail;
            EXPECT_NE(other.outcome, BranchOutcome::returned);
            EXPECT_FALSE(half_orbit(System(model), other.points[1].solution.orbit, 1e-4));
        }
    }
    EXPECT_FALSE(reference.special.empty());
}

} // namespace graze::units_test
