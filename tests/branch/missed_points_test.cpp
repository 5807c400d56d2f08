// Several multipliers that cross within one step or at one point, for maps with closed forms.

#include "follow.hpp"
#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace graze::missed_points_test {

using namespace graze::testing;

Branch of_map(const std::string& parameters, const std::vector<std::string>& images, double least, double greatest) {
    const Model model = map_model(parameters, images);
    return follow_branch(System(model), fixed_point(model, std::vector<double>(images.size(), 0.0)),
                         in_parameter(model, "p", least, greatest));
}

TEST(MissedPoints, TwoFlipsWithinOneStepAreBothFound) {
    for (const double apart : {1e-3, 1e-5}) {
        const Branch branch =
            of_map("p = 0.5", {"-p*x - 0.5*x^3", fmt::format("-p*y/{:.17g} - 0.5*y^3", 1 + apart)}, 0.1, 1.9);
        ASSERT_EQ(names(branch), "PD PD BD") << apart;
        EXPECT_NEAR(branch.special[0].parameter, 1, 1e-9);
        EXPECT_NEAR(branch.special[1].parameter, 1 + apart, 1e-9);
    }
}

TEST(MissedPoints, TwoBranchPointsWithinOneStepAreBothFound) {
    const Branch branch = of_map("p = 0.5", {"p*x - x^3", "p*y/1.001 - y^3"}, 0.2, 1.9);
    ASSERT_EQ(names(branch), "BP BP BD");
    EXPECT_NEAR(branch.special[0].parameter, 1, 1e-7);
    EXPECT_NEAR(branch.special[1].parameter, 1.001, 1e-7);
}

TEST(MissedPoints, MultipliersThatCrossTogetherAreCounted) {
    const Branch flips = of_map("p = 0.5", {"-p*x - 0.5*x^3", "-p*y - 0.5*y^3"}, 0.1, 1.9);
    ASSERT_EQ(names(flips), "PD BD");
    EXPECT_NEAR(flips.special[0].parameter, 1, 1e-8);
    EXPECT_NE(flips.special[0].detail.find("2 multipliers cross -1 at once"), std::string::npos);
    const Branch crossings = of_map("p = 0.5", {"p*x - x^3", "p*y - y^3"}, 0.2, 1.9);
    ASSERT_EQ(names(crossings), "BP BD");
    EXPECT_NEAR(crossings.special[0].parameter, 1, 1e-6);
    EXPECT_NE(crossings.special[0].detail.find("2 multipliers cross 1 at once"), std::string::npos);
}

TEST(MissedPoints, PitchforkFromTheBifurcatingBranchIsOnePoint) {
    const Model model = map_model("p = 1.3", {"p*x - x^3"});
    const BranchSettings settings = in_parameter(model, "p", 0.5, 3, -1);
    const Branch branch = follow_branch(System(model), fixed_point(model, {std::sqrt(0.3)}), settings);
    EXPECT_EQ(of_type(branch, PointType::fold).size(), 0U) << names(branch);
    ASSERT_EQ(of_type(branch, PointType::branch_point).size(), 1U) << names(branch);
    EXPECT_NEAR(of_type(branch, PointType::branch_point)[0].parameter, 1, 1e-9);
}

TEST(MissedPoints, CoefficientsBelowRoundOffAreUndecided) {
    const Branch flip = of_map("p = 0.5", {"-p*x + 0.3"}, 0.1, 1.9);
    ASSERT_EQ(of_type(flip, PointType::flip).size(), 1U) << names(flip);
    EXPECT_TRUE(of_type(flip, PointType::flip)[0].detail.starts_with("criticality not decided"))
        << of_type(flip, PointType::flip)[0].detail;
    const Branch torus = of_map("p = -0.3", {"(1 + p)*(0.6*x - 0.8*y)", "(1 + p)*(0.8*x + 0.6*y)"}, -0.5, 0.5);
    ASSERT_EQ(of_type(torus, PointType::torus).size(), 1U) << names(torus);
    EXPECT_TRUE(of_type(torus, PointType::torus)[0].detail.starts_with("criticality not decided"))
        << of_type(torus, PointType::torus)[0].detail;
}

TEST(MissedPoints, MultiplierThatCrossesTwiceWithinOneStepIsFound) {
    for (const double apart : {1e-3, 3e-4}) {
        SCOPED_TRACE(apart);
        const std::string depth = fmt::format("(p - 0.3)*(p - {:.17g})", 0.3 + apart);
        const Branch flips = of_map("p = 0.25", {"(-1 + 40*" + depth + ")*x - 0.5*x^3"}, 0.2, 0.4);
        ASSERT_EQ(names(flips), "PD PD BD");
        EXPECT_NEAR(flips.special[0].parameter, 0.3, 1e-8);
        EXPECT_NEAR(flips.special[1].parameter, 0.3 + apart, 1e-8);
        const std::string growth = "(1 - 40*" + depth + " - x^2 - y^2)";
        const Branch tori = of_map("p = 0.25", {growth + "*(0.6*x - 0.8*y)", growth + "*(0.8*x + 0.6*y)"}, 0.2, 0.4);
        ASSERT_EQ(names(tori), "NS NS BD");
        EXPECT_NEAR(tori.special[0].parameter, 0.3, 1e-8);
        EXPECT_NEAR(tori.special[1].parameter, 0.3 + apart, 1e-8);
    }
    for (const double apart : {3e-3, 1e-3}) {
        SCOPED_TRACE(apart);
        const Branch crossings =
            of_map("p = 0.25", {fmt::format("x - 100*(p - 0.3)*(p - {:.17g})*x - x^3", 0.3 + apart)}, 0.2, 0.4);
        ASSERT_EQ(names(crossings), "BP BP BD");
        EXPECT_NEAR(crossings.special[0].parameter, 0.3, 1e-7);
        EXPECT_NEAR(crossings.special[1].parameter, 0.3 + apart, 1e-7);
    }
}

/// Orbits of a clock that pass a wall at a distance that is negative between two values of p.
Branch beside_wall(bool stop) {
    const Model model = OneMode{.parameters = "p = 0",
                                .states = "x = 0\nclock = 0",
                                .definitions = "clearance = '40*(p - 0.3)*(p - 0.3001)'",
                                .rates = "x = '-x', clock = 1",
                                .stops = {{"tick", "1 - clock", "x = '0.5*x + 1'\nclock = 0", "map"},
                                          {"wall", "1 + clearance - sin(2*pi*clock)", "x = '-x'"}}}
                            .model();
    BranchSettings settings = in_parameter(model, "p", -0.1, 0.7);
    settings.stop_when_unphysical = stop;
    return follow_branch(System(model), fixed_point(model, {1}), settings);
}

TEST(MissedPoints, FirstOfTwoTouchesWithinOneStepEndsTheBranch) {
    const Branch all = beside_wall(false);
    ASSERT_EQ(names(all), "GR GR BD");
    EXPECT_NEAR(all.special[0].parameter, 0.3, 1e-9);
    EXPECT_NEAR(all.special[1].parameter, 0.3001, 1e-9);
    const Branch followed = beside_wall(true);
    ASSERT_EQ(names(followed), "GR");
    EXPECT_EQ(followed.outcome, BranchOutcome::unphysical);
    EXPECT_NEAR(followed.points.back().parameter, 0.3, 1e-9);
}

/// Returns the branch of a map towards smaller p.
Branch of_map_from(const std::string& image, double p, double x, double least) {
    const Model model = map_model(fmt::format("p = {}", p), {image});
    return follow_branch(System(model), fixed_point(model, {x}), in_parameter(model, "p", least, p + 0.1, -1));
}

TEST(MissedPoints, ContinuationDoesNotJumpToANearbyBranch) {
    for (const double broken : {1e-6, 1e-7, 1e-8}) {
        SCOPED_TRACE(broken);
        const Branch pitchfork =
            of_map_from(fmt::format("x + 0.3*((p - 0.3)*x - x^3 + {})", broken), 0.7, std::sqrt(0.4), 0.1);
        EXPECT_EQ(names(pitchfork), "BD");
        EXPECT_NEAR(pitchfork.points.back().parameter, 0.1, 1e-12);
        for (const BranchPoint& point : pitchfork.points)
            EXPECT_GT(point.solution.orbit.starts[0][0], 0);
    }
    const Branch transcritical = of_map_from("x + 0.3*((p - 0.3)^2 + 1e-9 - x^2)", 0.6, 0.3, -0.1);
    EXPECT_EQ(names(transcritical), "BD");
    EXPECT_NEAR(transcritical.points.back().solution.orbit.starts[0][0], 0.4, 1e-8);
}

} // namespace graze::missed_points_test
