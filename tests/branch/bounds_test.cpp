// Bounds hold also if the last step contains branch points, folds, or both.

#include "branch/bounds.hpp"
#include "driven_oscillator.hpp"
#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace graze::bounds_test {

using namespace graze::testing;
using std::numbers::pi;

/// u' = growth(u, mu) about x = cos(theta).
Model about_a_clock(const std::string& growth) {
    return about_clock("mu = 1", growth);
}

Orbit orbit_at(const Model& model, double mu, double u) {
    return {parse_signature(model, "start"), {mu}, {{1 + u, 0}}, {2 * pi}, std::nullopt};
}

void expect_within(const Branch& branch, double least, double greatest) {
    EXPECT_EQ(branch.outcome, BranchOutcome::bound) << branch.detail << ' ' << names(branch);
    for (const BranchPoint& point : branch.points) {
        EXPECT_GE(point.parameter, least);
        EXPECT_LE(point.parameter, greatest);
        EXPECT_EQ(point.solution.orbit.parameters[0], point.parameter);
    }
    for (const SpecialPoint& point : branch.special) {
        EXPECT_GE(point.parameter, least) << short_name(point.type);
        EXPECT_LE(point.parameter, greatest) << short_name(point.type);
    }
    ASSERT_FALSE(branch.points.empty());
    const double end = branch.points.back().parameter;
    EXPECT_TRUE(end == least || end == greatest) << end;
}

TEST(Bounds, OneOfThemAloneIsABound) {
    const Model model = about_a_clock("mu - u");
    const auto put = [&](std::optional<double> least, std::optional<double> greatest, double mu) {
        BranchSettings settings = in_parameter(model, "mu", 0, 1);
        settings.least = least;
        settings.greatest = greatest;
        Orbit orbit = orbit_at(model, mu, 0);
        put_on_bounds(settings, orbit);
        return orbit.parameters[0];
    };
    EXPECT_EQ(put(0, {}, -0.1), 0);
    EXPECT_EQ(put({}, 0, 0.1), 0);
    EXPECT_EQ(put(0, {}, 0.1), 0.1);
    EXPECT_EQ(put({}, 0, -0.1), -0.1);
    EXPECT_EQ(put({}, {}, 5), 5);
}

TEST(Bounds, HoldNearAndAtABranchPoint) {
    // Two straight branches cross at mu = 0: u = mu and u = 0.
    const Model model = about_a_clock("mu*u - u^2");
    for (const double bound : {0.0, 1e-3, 1e-7, 1e-10, -1e-10, -1e-7, -1e-4, -0.01, -0.3})
        for (const bool straight : {false, true}) {
            const Branch branch = follow_branch(System(model), orbit_at(model, 1, straight ? 0 : 1),
                                                in_parameter(model, "mu", bound, 2, -1));
            expect_within(branch, bound, 2);
            EXPECT_EQ(branch.points.back().parameter, bound) << bound;
            if (bound <= 0 || bound > 1e-9) { // just before the crossing, round-off decides on which side the bound is
                EXPECT_EQ(names(branch), bound <= 0 ? "BP BD" : "BD") << bound;
            }
            for (const SpecialPoint& point : of_type(branch, PointType::branch_point))
                EXPECT_NEAR(point.parameter, 0, 1e-9);
        }
    // From below, towards the other bound.
    for (const double bound : {0.0, 1e-4, -1e-4}) {
        const Branch branch =
            follow_branch(System(model), orbit_at(model, -1, 0), in_parameter(model, "mu", -2, bound, 1));
        expect_within(branch, -2, bound);
        EXPECT_EQ(branch.points.back().parameter, bound);
    }
}

TEST(Bounds, HoldNearAPitchforkAndAFold) {
    // On the parabola mu = u^2 the fold is at the crossing with the other branch.
    const Model pitchfork = about_a_clock("mu*u - u^3");
    for (const double bound : {1e-2, 1e-4, 1e-7})
        expect_within(
            follow_branch(System(pitchfork), orbit_at(pitchfork, 1, 1), in_parameter(pitchfork, "mu", bound, 2, -1)),
            bound, 2);
    const Model fold = about_a_clock("mu - u^2");
    for (const double bound : {1e-2, 1e-5, 1e-9})
        expect_within(follow_branch(System(fold), orbit_at(fold, 1, 1), in_parameter(fold, "mu", bound, 2, -1)), bound,
                      2);
    const Branch beyond = follow_branch(System(fold), orbit_at(fold, 1, 1), in_parameter(fold, "mu", -1e-3, 2, -1));
    expect_within(beyond, -1e-3, 2);
    EXPECT_EQ(names(beyond), "SN BD");
    EXPECT_EQ(beyond.points.back().parameter, 2);
}

TEST(Bounds, HoldOnBranchesThatLeaveAPoint) {
    const Model model = about_a_clock("mu*u - u^2");
    for (const double bound : {-1e-3, -1e-5, -0.5}) {
        const BranchSettings settings = in_parameter(model, "mu", bound, 2, -1);
        const Branch first = follow_branch(System(model), orbit_at(model, 1, 0), settings);
        const auto points = of_type(first, PointType::branch_point);
        ASSERT_EQ(points.size(), 1U);
        std::size_t reached = 0;
        for (const BranchStart& start : branches_at(System(model), points.front(), settings)) {
            const Branch other = follow(model, start, settings);
            for (const BranchPoint& point : other.points) {
                EXPECT_GE(point.parameter, bound);
                EXPECT_NEAR(point.solution.orbit.starts[0][0] - 1, point.parameter, 1e-9);
            }
            EXPECT_EQ(other.outcome, BranchOutcome::bound);
            reached += other.points.empty() ? 0 : 1;
        }
        EXPECT_GE(reached, 1U);
    }
}

TEST(Bounds, BoundsOfMonitorsHoldFromTheFirstOrbitOn) {
    const Model model = about_a_clock("mu - u");
    BranchSettings settings = in_parameter(model, "mu", -2, 2, 1);
    settings.monitors = {{"start", "", Monitor::Kind::start, model.symbol("x"), "", false, {}, {}, 1.2, 1.5}};
    const Branch none = follow_branch(System(model), orbit_at(model, 1, 1), settings);
    EXPECT_TRUE(none.points.empty());
    EXPECT_EQ(none.outcome, BranchOutcome::bound);
    EXPECT_NE(none.detail.find("start = 2"), std::string::npos) << none.detail;
    const Branch branch = follow_branch(System(model), orbit_at(model, 0.3, 0.3), settings);
    EXPECT_EQ(branch.outcome, BranchOutcome::bound);
    EXPECT_NEAR(branch.points.back().parameter, 0.5, 1e-9);
}

TEST(Bounds, OrbitsThatLeaveATouchNearABoundBeginWithinIt) {
    const DrivenOscillator known;
    const Model model = known.model();
    const SpecialPoint touch = known.grazing(model);
    for (const double side : {1.0, -1.0}) {
        BranchSettings settings = in_parameter(model, "F");
        (side > 0 ? settings.least : settings.greatest) = known.force() * (1 - side * 1e-4);
        const BranchStart start = branches_at(System(model), touch, settings).front();
        const double force = start.orbit.parameters[settings.parameter.place()];
        EXPECT_LT(std::abs(force / known.force() - 1), 0.1);
        EXPECT_TRUE(side > 0 ? force >= *settings.least : force <= *settings.greatest) << force;
    }
}

} // namespace graze::bounds_test
