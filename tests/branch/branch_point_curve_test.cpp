// Curves of branch points of models without declared symmetry, against closed forms.

#include "follow.hpp"

#include "graze/branch/orbit_branch.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace graze::branch_point_curve_test {

using namespace graze::testing;

Model hidden(const std::string& rate, double length = 1, double time = 1) {
    return about_clock("a = 0.3\nb = 0.8", rate, 0, "", length, time);
}

struct Followed {
    Branch branch, curve;
};

/// Follows the branch u = 0 in a, and the curve of its first branch point in a and b.
Followed followed(const Model& model) {
    BranchSettings settings = in_parameter(model, "a", -2, 2);
    Followed result;
    result.branch = follow_branch(System(model), settled(model, "start", 4000).orbit, settings);
    const auto points = of_type(result.branch, PointType::branch_point);
    if (points.empty())
        return result;
    result.curve = curve_of(model, points.front(), settings, "b", 0.2, 1.5, 1);
    return result;
}

void expect_on(const Branch& curve, double (*first)(double)) {
    ASSERT_GT(curve.points.size(), 5U) << name_of(curve.outcome) << curve.detail;
    EXPECT_EQ(curve.outcome, BranchOutcome::bound);
    for (const BranchPoint& point : curve.points) {
        const auto& parameters = point.solution.orbit.parameters;
        // The accuracy of the integration over a period without growth.
        EXPECT_NEAR(parameters[0], first(parameters[1]), 1e-11);
        EXPECT_LT(nearest_multiplier(point.solution, 1), 1e-10);
    }
}

TEST(BranchPointCurve, PitchforkHasItsClosedForm) {
    using Units = std::pair<double, double>;
    for (const auto& [length, time] : {Units(1, 1), Units(1e-9, 1e-6), Units(1e6, 1e3)}) {
        const Followed found = followed(hidden("(a - b^2)*u - u^3", length, time));
        ASSERT_FALSE(of_type(found.branch, PointType::branch_point).empty()) << names(found.branch);
        EXPECT_NEAR(of_type(found.branch, PointType::branch_point)[0].parameter, 0.64, 1e-9);
        expect_on(found.curve, [](double b) { return b * b; });
        EXPECT_NEAR(found.curve.points.back().solution.orbit.parameters[0], 2, 1e-12);
    }
}

TEST(BranchPointCurve, TranscriticalPointHasItsClosedForm) {
    const Followed found = followed(hidden("(a - b^3)*u - u^2"));
    ASSERT_FALSE(of_type(found.branch, PointType::branch_point).empty()) << names(found.branch);
    expect_on(found.curve, [](double b) { return b * b * b; });
}

TEST(BranchPointCurve, DoesNotBeginWhereThePerturbationSeparatesTheBranches) {
    // The two branches cross at b = 0.8 only.
    const Followed found = followed(hidden("(a - b^2)*u - u^3 + (b - 0.8)*(1 + sin(theta))/10"));
    ASSERT_FALSE(of_type(found.branch, PointType::branch_point).empty()) << names(found.branch);
    EXPECT_NE(found.curve.outcome, BranchOutcome::bound);
    for (const BranchPoint& point : found.curve.points) // the first point, and points that differ by round-off
        EXPECT_NEAR(point.solution.orbit.parameters[1], 0.8, 1e-5);
    EXPECT_NE(found.curve.detail.find("separate there"), std::string::npos) << found.curve.detail;
}

/// Symmetry breaking of orbits with impacts, with the symmetry declared (half orbits) and undeclared (whole orbits).
TEST(BranchPointCurve, EqualsTheSymmetryBreakingOfAnUndeclaredSymmetry) {
    Model model = started(load_model("electromagnetic-testbed"), {{"I", 0.1}});
    std::vector<double> ends;
    for (const bool declared : {true, false}) {
        const PointType type = declared ? PointType::asymmetry : PointType::branch_point;
        if (!declared)
            model.symmetries.clear();
        BranchSettings settings = in_parameter(model, "V0");
        settings.stop_at = {type};
        const OrbitSolution start = settled(model, "phase0", 600);
        ASSERT_EQ(start.orbit.symmetry.has_value(), declared);
        const Branch branch = follow_branch(System(model), start.orbit, settings);
        ASSERT_EQ(branch.special.back().type, type) << names(branch);
        EXPECT_NEAR(branch.special.back().parameter, 4.846244144797, 1e-9);
        settings.stop_at.clear();
        settings.kept = branch.special.back();
        settings.free = {settings.parameter};
        settings.parameter = model.independent_parameter("f");
        settings.greatest = 6.252;
        const Branch curve = follow_branch(System(model), branch.special.back().solution.orbit, settings);
        ASSERT_EQ(curve.outcome, BranchOutcome::bound) << declared << curve.detail << curve.points.back().parameter;
        ends.push_back(curve.points.back().solution.orbit.parameters[settings.free[0].place()]);
        EXPECT_GT(std::abs(ends.back() - branch.special.back().parameter), 1e-4);
    }
    EXPECT_NEAR(ends[0], ends[1], 1e-9);
}

} // namespace graze::branch_point_curve_test
