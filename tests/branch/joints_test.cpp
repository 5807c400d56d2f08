// Points at which curves of special points meet, for maps and touches with closed forms.

#include "maps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

namespace graze::joints_test {

using namespace graze::testing;

/// Returns the only point of a type; there must be exactly one.
SpecialPoint only(const Branch& branch, PointType type) {
    const auto all = of_type(branch, type);
    EXPECT_EQ(all.size(), 1U) << short_name(type) << " in " << names(branch) << branch.detail;
    return all.empty() ? SpecialPoint{} : all.front();
}

/// Returns the point as one of another type, for another curve.
SpecialPoint as(SpecialPoint point, PointType type) {
    point.type = type;
    return point;
}

/// Fixed points (x - 1)^2 = -p of x -> x + p + (x - 1)^2, with a fold at p = 0.
Orbit stable_point(const Model& model, double p, std::vector<double> rest) {
    rest.insert(rest.begin(), 1 - std::sqrt(-p));
    return fixed_point(model, rest);
}

TEST(Joints, FoldAndFlipCurvesMeetInAFoldFlip) {
    // Multipliers 1 + 2 u and -(1 + q + u/2), with u = x - 1: folds at p = 0, flips at q = -u/2 with p = -u^2.
    const Model model =
        map_model("p = -0.04\nq = -0.3", {"x + p + (x - 1)^2", "2 - (1 + q + (x - 1)/2)*(y - 2) + (y - 2)^3"});
    const BranchSettings in_p = in_parameter(model, "p", -1, 1), in_q = in_parameter(model, "q", -0.5, 0.4);
    const Orbit start = stable_point(model, -0.04, {2});
    const SpecialPoint fold = only(follow_branch(System(model), start, in_p), PointType::fold),
                       flip = only(follow_branch(System(model), start, in_q), PointType::flip);
    const Branch folds = curve_of(model, fold, in_q, "p", -1, 1, 1);
    EXPECT_EQ(names(folds), "FP BD");
    const SpecialPoint on_folds = only(folds, PointType::fold_flip);
    EXPECT_NEAR(on_folds.parameter, 0, 1e-11);
    EXPECT_NEAR(value_of(model, on_folds.solution, "p"), 0, 1e-11);
    // The curve of flips is tangent to that of folds and continues on its other side.
    const Branch flips = curve_of(model, flip, in_q, "p", -0.09, 1, -1);
    const SpecialPoint on_flips = only(flips, PointType::fold_flip);
    EXPECT_NEAR(on_flips.parameter, 0, 1e-11);
    EXPECT_NEAR(value_of(model, on_flips.solution, "p"), 0, 1e-11);
    EXPECT_LT(nearest_multiplier(on_flips.solution, 1), 1e-6);
    EXPECT_LT(nearest_multiplier(on_flips.solution, -1), 1e-8);
    for (const int way : {1, -1}) {
        const Branch onward = curve_of(model, as(on_folds, PointType::flip), in_q, "p", -0.09, 1, way);
        ASSERT_GT(onward.points.size(), 5U) << onward.detail;
        EXPECT_EQ(names(onward), "BD");
        for (const BranchPoint& one : onward.points) {
            const double u = one.solution.orbit.starts[0][0] - 1;
            EXPECT_NEAR(one.parameter, -u / 2, 1e-11);
            EXPECT_NEAR(value_of(model, one.solution, "p"), -u * u, 1e-11);
        }
        const Branch of_folds = curve_of(model, as(on_flips, PointType::fold), in_q, "p", -0.09, 1, way);
        EXPECT_EQ(names(of_folds), "BD");
        for (const BranchPoint& one : of_folds.points)
            EXPECT_NEAR(value_of(model, one.solution, "p"), 0, 1e-11);
    }
}

TEST(Joints, TorusCurvesMeetThoseOfFoldsAndFlips) {
    // A pair (1 + q + r) exp(+-0.9 i), where r is (x - 1)/2 beside a fold in x, and p/2 beside a flip.
    const auto turning = [](const std::string& growth) {
        const std::string g = fmt::format("(1 + q + {} - 0.3*((y - 2)^2 + (z - 3)^2))", growth);
        return std::vector<std::string>{"2 + " + g + "*(cos(0.9)*(y - 2) - sin(0.9)*(z - 3))",
                                        "3 + " + g + "*(sin(0.9)*(y - 2) + cos(0.9)*(z - 3))"};
    };
    for (const bool folds : {true, false}) {
        std::vector<std::string> images = turning(folds ? "(x - 1)/2" : "p/2");
        images.insert(images.begin(), folds ? "x + p + (x - 1)^2" : "1 - (1 + p)*(x - 1) + (x - 1)^3");
        const Model model = map_model("p = -0.04\nq = -0.3", images);
        const BranchSettings in_p = in_parameter(model, "p", -1, 1), in_q = in_parameter(model, "q", -0.5, 0.4);
        const Orbit start = folds ? stable_point(model, -0.04, {2, 3}) : fixed_point(model, {1, 2, 3});
        const PointType own = folds ? PointType::fold : PointType::flip,
                        meeting = folds ? PointType::fold_torus : PointType::flip_torus;
        const SpecialPoint first = only(follow_branch(System(model), start, in_p), own),
                           torus = only(follow_branch(System(model), start, in_q), PointType::torus);
        const Branch curve = curve_of(model, first, in_q, "p", -1, 1, 1);
        EXPECT_EQ(names(curve), folds ? "FT BD" : "PT BD");
        const Branch pairs = curve_of(model, torus, in_q, "p", -0.09, 0.3, folds ? -1 : 1);
        const Branch other = curve_of(model, torus, in_q, "p", -0.09, 0.3, folds ? 1 : -1);
        auto met = of_type(pairs, meeting);
        const auto others = of_type(other, meeting);
        met.insert(met.end(), others.begin(), others.end());
        ASSERT_EQ(met.size(), 1U) << names(pairs) << ", " << names(other);
        for (const SpecialPoint& one : {only(curve, meeting), met[0]}) {
            EXPECT_NEAR(one.parameter, 0, 1e-10);
            EXPECT_NEAR(value_of(model, one.solution, "p"), 0, 1e-10);
            EXPECT_LT(nearest_multiplier(one.solution, folds ? 1 : -1), 1e-5);
            double off = 1;
            for (const auto multiplier : one.solution.multipliers)
                off = std::min(off, std::abs(multiplier - std::polar(1.0, 0.9)));
            EXPECT_LT(off, 1e-8);
        }
        for (const int way : {1, -1}) {
            const Branch onward = curve_of(model, as(only(curve, meeting), PointType::torus), in_q, "p", -0.09, 1, way);
            ASSERT_GT(onward.points.size(), 5U) << onward.detail;
            for (const BranchPoint& one : onward.points) {
                const double u = one.solution.orbit.starts[0][0] - 1, p = value_of(model, one.solution, "p");
                EXPECT_NEAR(one.parameter, folds ? -u / 2 : -p / 2, 1e-11);
                EXPECT_NEAR(folds ? p : u, folds ? -u * u : 0, 1e-11);
            }
        }
    }
}

/// A phase with an event function that has the minima b - 1 - c at 3 pi/2 and b - 1 + c at pi/2.
Model two_dips() {
    return OneMode{.parameters = "b = 1.7\nc = 0.2",
                   .states = "x = 0",
                   .rates = "x = '-x'",
                   .clock = "1",
                   .stops = {{"dip", "b + cos(2*theta) + c*sin(theta)", "x = 'x + 1'"}}}
        .model();
}

TEST(Joints, OneEventTouchedTwiceIsADoubleGrazing) {
    const Model model = two_dips();
    const BranchSettings settings = in_parameter(model, "b", -3, 3, -1);
    const Orbit start = given_orbit(model, "start", {{0, 0}}, {2 * std::numbers::pi});
    const SpecialPoint touch = only(follow_branch(System(model), start, settings), PointType::grazing);
    EXPECT_NEAR(touch.parameter, 1.2, 1e-13);
    const Branch curve = curve_of(model, touch, settings, "c", -0.5, 0.5, -1);
    EXPECT_EQ(curve.outcome, BranchOutcome::unphysical) << curve.detail;
    ASSERT_FALSE(curve.special.empty());
    const SpecialPoint both = curve.special.back();
    EXPECT_EQ(both.type, PointType::double_grazing) << names(curve);
    EXPECT_EQ(both.detail, "dip");
    EXPECT_NEAR(both.parameter, 1, 1e-12);
    EXPECT_NEAR(value_of(model, both.solution, "c"), 0, 1e-12);
    for (const BranchPoint& one : curve.points)
        EXPECT_NEAR(one.parameter, 1 + value_of(model, one.solution, "c"), 1e-12);
    // Continue with the other touch, which is the relevant one for negative c.
    const Branch other = curve_of(model, as(both, PointType::grazing), settings, "c", -0.5, 0.5, 1);
    ASSERT_GT(other.points.size(), 3U);
    for (const BranchPoint& one : other.points)
        EXPECT_NEAR(one.parameter, 1 - value_of(model, one.solution, "c"), 1e-12);
    EXPECT_EQ(names(other), "BD");
}

TEST(Joints, TwoTouchedStopsAreADoubleGrazing) {
    // x'' + 2 zeta x' + x = F cos(omega t) between stops at -a and b, where the response has this radius for F = 1.
    const double zeta = 0.1, omega = 1.3, radius = 1 / std::hypot(1 - omega * omega, 2 * zeta * omega);
    const Model model = driven("F = 0.3\na = 1\nb = 1.5", "F*cos(theta) - 0.2*v - x", "1.3",
                               {{"lower", "a + x", "v = '-0.8*v'"}, {"upper", "b - x", "v = '-0.8*v'"}});
    BranchSettings settings = in_parameter(model, "F", 0.1, 10);
    const SpecialPoint touch =
        only(follow_branch(System(model), settled(model, "start").orbit, settings), PointType::grazing);
    EXPECT_EQ(touch.detail, "lower");
    const Branch curve = curve_of(model, touch, settings, "a", 0.5, 3, 1);
    EXPECT_EQ(curve.outcome, BranchOutcome::unphysical) << curve.detail;
    ASSERT_FALSE(curve.special.empty());
    const SpecialPoint both = curve.special.back();
    EXPECT_EQ(both.type, PointType::double_grazing) << names(curve);
    EXPECT_EQ(both.detail, "upper");
    EXPECT_NEAR(value_of(model, both.solution, "a"), 1.5, 1e-11);
    EXPECT_NEAR(both.parameter, 1.5 / radius, 1e-11);
    // Along the touches of the other stop, and down along those of the first one.
    SpecialPoint along = as(both, PointType::grazing);
    const Branch upper = curve_of(model, along, settings, "a", 0.5, 3, -1);
    EXPECT_GE(upper.points.size(), 2U);
    for (const BranchPoint& one : upper.points)
        EXPECT_NEAR(one.parameter, 1.5 / radius, 1e-11);
}

TEST(Joints, DoubleGrazingLeadsToOrbitsWithOneMoreContact) {
    const Model model = started(shipped_with("mems-switch", {{"V", 0.05}}), {{"q", 0}, {"v", 0}});
    BranchSettings settings = in_parameter(model, "V", 0.01, 5);
    const SpecialPoint touch =
        only(follow_branch(System(model), settled(model, "phase0", 3000).orbit, settings), PointType::grazing);
    BranchSettings along = in_parameter(model, "omega", 0.2, 3);
    const SpecialPoint both = only(curve_of(model, touch, along, "V", 0.0001, 5, 1), PointType::double_grazing);
    EXPECT_EQ(both.detail.substr(0, 7), "closure");
    const std::vector<BranchStart> starts = branches_at(System(model), both, settings);
    ASSERT_EQ(starts.size(), 1U); // closure ends the motion
    EXPECT_NE(starts[0].how.find("one more contact at 'stop'"), std::string::npos) << starts[0].how;
    const Branch branch = follow(model, starts[0], settings);
    ASSERT_GT(branch.points.size(), 5U);
    EXPECT_TRUE(branch.points[1].solution.certificate.admissible);
}

TEST(Joints, LabelsDetermineTheirTypes) {
    EXPECT_EQ(point_label(PointType::fold, 12), "SN12");
    EXPECT_EQ(point_label(PointType::resonance_1, 1), "R1-1");
    EXPECT_EQ(point_label(PointType::resonance_4, 10), "R4-10");
    for (const char* good : {"SN1", "GR12", "R1-1", "R3-20", "FP1", "DG2"})
        EXPECT_TRUE(is_point_label(good)) << good;
    for (const char* bad : {"", "SN", "R1", "R11", "R1-", "SN-1", "SN1a", "XX1", "1"})
        EXPECT_FALSE(is_point_label(bad)) << bad;
}

} // namespace graze::joints_test
