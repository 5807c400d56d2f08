// Branches of orbits that first touch their section and then no longer reach it: orbits and multipliers have closed
// forms that do not depend on sections.

#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::touched_section_test {

using namespace graze::testing;
using std::numbers::pi;

/// A circle of radius r with r' = r g(r, mu) and frequency w in the plane of x and y; the section is x = level.
OneMode circle(const std::string& growth, double level, const std::string& direction) {
    return {.parameters = "mu = 1",
            .states = "x = 1\ny = 0",
            .definitions = fmt::format("w = 1.3\ns = 'x^2 + y^2'\ng = '{}'", growth),
            .rates = "x = 'g*x - w*y', y = 'w*x + g*y'",
            .more = section("level", fmt::format("x - {:.17g}", level), direction)};
}
constexpr double round = 2 * pi / 1.3;

Orbit on_circle(const Model& model, double mu, double radius, double level, bool falling,
                std::vector<double> further = {}) {
    const double y = std::sqrt(radius * radius - level * level) * (falling ? 1 : -1);
    std::vector<double> start{level, y};
    start.insert(start.end(), further.begin(), further.end());
    return {parse_signature(model, "level"), {mu}, {start}, {round}, std::nullopt};
}

double radius_of(const BranchPoint& point) {
    const std::vector<double>& start = point.solution.orbit.starts[0];
    return std::hypot(start[0], start[1]);
}

TEST(TouchedSection, CircleShrinksThroughIt) {
    for (const bool falling : {true, false})
        for (const double level : {0.5, -0.4}) {
            const Model model = circle("mu - s", level, falling ? "falling" : "rising").model();
            BranchSettings settings = in_parameter(model, "mu", 0.01, 2, -1);
            const Branch branch = follow_branch(System(model), on_circle(model, 1, 1, level, falling), settings);
            EXPECT_EQ(branch.outcome, BranchOutcome::bound) << branch.detail;
            EXPECT_EQ(names(branch), "BD") << level << falling;
            for (const BranchPoint& point : branch.points) {
                EXPECT_NEAR(radius_of(point), std::sqrt(point.parameter), 1e-9);
                EXPECT_NEAR(point.solution.orbit.period(), round, 1e-9);
                ASSERT_EQ(point.solution.multipliers.size(), 1U);
                EXPECT_NEAR(point.solution.multipliers[0].real(), std::exp(-2 * point.parameter * round), 1e-8);
                EXPECT_TRUE(point.stable);
            }
            EXPECT_EQ(to_string(model, branch.points.front().solution.orbit.signature), "level");
            EXPECT_EQ(to_string(model, branch.points.back().solution.orbit.signature), "~");
            // And back from there, with the cut, to a large circle.
            settings.direction = 1;
            const Branch back = follow_branch(System(model), branch.points.back().solution.orbit, settings);
            EXPECT_EQ(names(back), "BD");
            EXPECT_EQ(back.points.back().parameter, 2);
            EXPECT_NEAR(radius_of(back.points.back()), std::sqrt(2.0), 1e-9);
        }
}

/// r' = r (mu + r^2 - r^4): two circles meet at mu = -1/4, inside the section.
TEST(TouchedSection, FoldBeyondItIsFound) {
    const double level = 0.8;
    const Model model = circle("mu + s - s^2", level, "falling").model();
    const BranchSettings settings = in_parameter(model, "mu", -1, -0.05, -1);
    const double mu = -0.1, radius = std::sqrt(0.5 + std::sqrt(0.25 + mu));
    const Branch branch = follow_branch(System(model), on_circle(model, mu, radius, level, true), settings);
    ASSERT_EQ(names(branch), "SN BD") << branch.detail;
    EXPECT_NEAR(branch.special[0].parameter, -0.25, 1e-10);
    EXPECT_EQ(branch.special[1].parameter, -0.05);
    for (const BranchPoint& point : branch.points) {
        const double s = std::pow(radius_of(point), 2);
        EXPECT_NEAR(point.parameter + s - s * s, 0, 1e-9);
    }
    // Not at the touch of the section, s = level^2.
    EXPECT_LT(radius_of(branch.points.back()), level);
}

/// In addition to the circle (p, q), which rotate by half a turn per period: multipliers -exp(a T) and -exp(-T). Orbits
/// of twice the period with p^2 = a bifurcate at a = mu - 0.1 = 0.
const char* const half_turns = ", p = '(0.5*(a - 1) - (p^2 + q^2))*p + 0.5*(a + 1)*(c*p + d*q) - 0.5*w*q'"
                               ", q = '(0.5*(a - 1) - (p^2 + q^2))*q + 0.5*(a + 1)*(d*p - c*q) + 0.5*w*p'";

TEST(TouchedSection, FlipBeyondItIsFoundAndSwitchedAt) {
    const double level = 0.5;
    OneMode parts = circle("mu - s", level, "falling");
    parts.states += "\np = 0\nq = 0";
    parts.definitions += "\na = 'mu - 0.1'\nc = 'x/sqrt(s)'\nd = 'y/sqrt(s)'";
    parts.rates += half_turns;
    const Model model = parts.model();
    BranchSettings settings = in_parameter(model, "mu", 0.02, 0.9, -1);
    const Branch branch =
        follow_branch(System(model), on_circle(model, 0.9, std::sqrt(0.9), level, true, {0, 0}), settings);
    ASSERT_EQ(names(branch), "PD BD") << branch.detail;
    expect_flip(branch.special[0]);
    EXPECT_NEAR(branch.special[0].parameter, 0.1, 1e-9);
    for (const BranchPoint& point : branch.points)
        EXPECT_LT(nearest_multiplier(point.solution, -std::exp((point.parameter - 0.1) * round)), 1e-6);
    const Branch doubled = follow(model, branches_at(System(model), branch.special[0], settings).front(), settings);
    ASSERT_GT(doubled.points.size(), 5U) << doubled.detail;
    for (const BranchPoint& point : doubled.points) {
        const std::vector<double>& start = point.solution.orbit.starts[0];
        EXPECT_NEAR(start[2] * start[2] + start[3] * start[3], point.parameter - 0.1, 1e-9);
        EXPECT_NEAR(point.solution.orbit.period(), 2 * round, 1e-9);
        EXPECT_NEAR(radius_of(point), std::sqrt(point.parameter), 1e-9);
    }
    EXPECT_EQ(names(doubled), "BD");
    // In the other direction it returns to the orbits of half its period.
    settings.direction = -1;
    const Branch back = follow_branch(System(model), doubled.points.back().solution.orbit, settings);
    EXPECT_EQ(back.outcome, BranchOutcome::returned) << back.detail << names(back);
    EXPECT_NEAR(back.points.back().parameter, 0.1, 1e-6);
}

/// The circle has two frequencies, on both sides of x = 0, and an additional section.
TEST(TouchedSection, OrbitsWithEventsContinueWithoutIt) {
    const Model model = TwoModes{.parameters = "mu = 1",
                                 .states = "x = 1\ny = 0",
                                 .definitions = "g = 'mu - x^2 - y^2'",
                                 .first = {"right", "x = 'g*x - 2*y', y = '2*x + g*y'", "in", "x"},
                                 .second = {"left", "x = 'g*x - y', y = 'x + g*y'", "out", "-x"},
                                 .more = section("level", "x - 0.5", "falling")}
                            .model();
    const double y = std::sqrt(0.75), angle = std::atan2(y, 0.5);
    const Orbit orbit = given_orbit(model, "in out level", {{0.5, y}, {0, 1}, {0, -1}},
                                    {0.5 * (pi / 2 - angle), pi, 0.5 * (pi / 2 + angle)});
    BranchSettings settings = in_parameter(model, "mu", 0.04, 2, -1);
    Branch branch = follow_branch(System(model), orbit, settings);
    EXPECT_EQ(names(branch), "BD") << branch.detail;
    EXPECT_EQ(branch.points.back().parameter, 0.04);
    EXPECT_EQ(to_string(model, branch.points.back().solution.orbit.signature), "in out");
    for (const BranchPoint& point : branch.points) {
        EXPECT_NEAR(radius_of(point), std::sqrt(point.parameter), 1e-9);
        EXPECT_NEAR(point.solution.orbit.period(), 1.5 * pi, 1e-9);
        EXPECT_NEAR(point.solution.multipliers.at(0).real(), std::exp(-3 * pi * point.parameter), 1e-8);
    }
    // A monitor at the section has no value beyond, so the branch ends there with the reason.
    settings.monitors = {{"speed", "", Monitor::Kind::value, model.symbol("y"), "level", false, {}, {}, {}, {}}};
    branch = follow_branch(System(model), orbit, settings);
    EXPECT_EQ(branch.outcome, BranchOutcome::undefined);
    EXPECT_EQ(names(branch), "");
    EXPECT_NE(branch.detail.find("section 'level'"), std::string::npos) << branch.detail;
    EXPECT_GE(branch.points.back().parameter, 0.25);
    EXPECT_LT(branch.points.back().parameter, 0.26);
}

TEST(TouchedSection, CurvesOfTouchesContinueWhereTheSectionIsTheTouch) {
    // The circle of radius mu^(1/2) touches the wall at its largest x, where the section is; with two walls it touches
    // both all along.
    for (const bool both : {false, true}) {
        OneMode parts{.parameters = "mu = 1\ns = 2",
                      .states = "x = 1\ny = 0",
                      .definitions = "g = 'mu - x^2 - y^2'",
                      .rates = "x = 'g*x - y', y = 'x + g*y'",
                      .stops = {{"right", "s - x", "y = '-0.5*y'", "R"}},
                      .more = section("greatest", "y")};
        if (both)
            parts.stops.push_back({"left", "s + x", "y = '-0.5*y'", "L"});
        const Model model = parts.model();
        const Orbit circle = given_orbit(model, "free:greatest", {{1, 0}}, {2 * pi});
        BranchSettings settings = in_parameter(model, "s", 0.3, 3, -1);
        const Branch branch = follow_branch(System(model), circle, settings);
        ASSERT_EQ(names(branch), "GR") << branch.detail;
        EXPECT_NEAR(branch.special[0].parameter, 1, 1e-12);
        for (const int way : {1, -1}) {
            const Branch curve = curve_of(model, branch.special[0], settings, "mu", 0.1, 8, way);
            EXPECT_EQ(names(curve), "BD") << both << ' ' << curve.detail;
            for (const BranchPoint& one : curve.points)
                EXPECT_NEAR(one.solution.orbit.parameters[0], one.parameter * one.parameter, 1e-10);
        }
    }
}

} // namespace graze::touched_section_test
