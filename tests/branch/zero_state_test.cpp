// Branches that leave orbits along which a state is zero, in any units, for maps with closed forms.

#include "follow.hpp"
#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace graze::zero_state_test {

using namespace graze::testing;

constexpr double units[] = {1, 1e-9, 1e6};

struct Case {
    std::string image; ///< map of x in its unit
    PointType type;
    double power;      ///< power of x that equals p on the other branch
    double multiplier; ///< multiplier at the point
};

class ZeroState : public ::testing::TestWithParam<Case> {};

TEST_P(ZeroState, OtherBranchLeavesItInAnyUnit) {
    for (const double unit : units) {
        SCOPED_TRACE(unit);
        const Model model = map_model(fmt::format("p = -0.2\nunit = {}", unit), {GetParam().image});
        const BranchSettings settings = in_parameter(model, "p", -0.4, 0.6);
        const Branch branch = follow_branch(System(model), fixed_point(model, {0}), settings);
        const auto points = of_type(branch, GetParam().type);
        ASSERT_EQ(points.size(), 1U) << names(branch);
        EXPECT_NEAR(points[0].parameter, 0, 1e-9);
        ASSERT_EQ(points[0].solution.multipliers.size(), 1U);
        EXPECT_NEAR(points[0].solution.multipliers[0].real(), GetParam().multiplier, 1e-6);
        for (const BranchStart& start : branches_at(System(model), points[0], settings)) {
            const Branch other = follow(model, start, settings);
            ASSERT_GT(other.points.size(), 3U) << other.detail;
            for (const BranchPoint& point : other.points) {
                const double x = point.solution.orbit.starts[0][0] / unit;
                EXPECT_NEAR(std::pow(x, GetParam().power), point.parameter, 1e-8);
                EXPECT_GT(std::abs(x), 1e-8);
            }
            EXPECT_NEAR(std::abs(other.points.back().parameter), 0.5, 0.11); // either bound
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Maps, ZeroState,
                         ::testing::Values(Case{"x + 0.5*x*(p - x/unit)", PointType::branch_point, 1, 1},
                                           Case{"x + 0.5*x*(p - (x/unit)^2)", PointType::branch_point, 2, 1},
                                           Case{"-(1 + 0.5*p)*x + 0.5*x*(x/unit)^2", PointType::flip, 2, -1}));

TEST(ZeroStateOfSettledOrbit, SymmetricOrbitsAreRecognised) {
    const Model model =
        OneMode{.parameters = "p = -0.3",
                .states = "x = 1\ny = 0\nz = 0.01",
                .definitions = "R = '1 - x^2 - y^2'",
                .rates = "x = 'x*R - 1.3*y', y = 'y*R + 1.3*x', z = 'p*z - z^3'",
                .more = section("start", "y") + "[symmetries.turned]\nmap = { x = '-x', y = '-y', z = '-z' }"}
            .model();
    const OrbitSolution solution = settled(model, "start");
    EXPECT_TRUE(solution.orbit.symmetry.has_value());
    const Branch branch = follow_branch(System(model), solution.orbit, in_parameter(model, "p", -0.5, 0.5));
    ASSERT_EQ(names(branch), "SB BD");
    EXPECT_NEAR(branch.special[0].parameter, 0, 1e-9);
    EXPECT_NEAR(branch.points.back().parameter, 0.5, 1e-12);
}

} // namespace graze::zero_state_test
