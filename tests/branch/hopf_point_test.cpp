// Hopf points do not depend on the section of orbits: textbook oscillators with closed forms, with sections that miss
// the equilibrium.

#include "follow.hpp"
#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::hopf_point_test {

using namespace graze::testing;
using std::numbers::pi;

/// Checks that the parameter is monotone up to the end of the branch, so that no part is followed twice.
void expect_no_return(const Branch& branch) {
    for (std::size_t k = 2; k < branch.points.size(); ++k)
        EXPECT_GT((branch.points[k].parameter - branch.points[k - 1].parameter) *
                      (branch.points[1].parameter - branch.points[0].parameter),
                  -1e-12)
            << k;
}

TEST(HopfPoint, MassOnABeltHasItsHopfPointForAnySection) {
    // The trace of the Jacobian at the equilibrium is 1 - a^2.
    for (const char* level : {"x", "x + 0.5", "x - 0.2", "x + 0.2", "v - 0.1", "x + 0.8", "v + 0.2", "x + v", "v"}) {
        const Model model = OneMode{.parameters = "a = 0.5",
                                    .states = "x = 1\nv = 0",
                                    .rates = "x = 'v', v = '-x - ((v-a)^3/3 - (v-a))'",
                                    .more = section("s", level)}
                                .model();
        const Branch branch = follow_branch(System(model), settled(model, "s").orbit, in_parameter(model, "a", 0.1, 2));
        EXPECT_EQ(names(branch), "EX HB") << level;
        EXPECT_EQ(branch.outcome, BranchOutcome::shrunk) << level;
        ASSERT_FALSE(branch.special.empty());
        EXPECT_NEAR(branch.special.back().parameter, 1, 1e-10) << level;
        EXPECT_NEAR(branch.special.back().solution.orbit.period(), 2 * pi, 1e-8) << level;
        expect_no_return(branch);
    }
}

TEST(HopfPoint, BrusselatorHasItsHopfPointForAnySection) {
    for (const char* level : {"x - 0.99", "x - 0.8", "x - 0.6", "x - 1.2", "x - 1.5", "x - 1"}) {
        const Model model = OneMode{.parameters = "a = 2.5",
                                    .states = "x = 1.5\ny = 2",
                                    .rates = "x = '1 - (a+1)*x + x^2*y', y = 'a*x - x^2*y'",
                                    .more = section("s", level)}
                                .model();
        const Branch branch =
            follow_branch(System(model), settled(model, "s").orbit, in_parameter(model, "a", 1, 4, -1));
        EXPECT_EQ(names(branch), "HB") << level;
        ASSERT_FALSE(branch.special.empty());
        EXPECT_NEAR(branch.special.back().parameter, 2, 1e-10) << level;
        EXPECT_NEAR(branch.special.back().solution.orbit.period(), 2 * pi, 1e-8) << level;
        expect_no_return(branch);
    }
}

} // namespace graze::hopf_point_test
