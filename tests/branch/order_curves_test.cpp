// Curves along which events keep coming at once, a segment takes no time, or a guard is about to change: all closed
// forms.

#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace graze {
namespace {

using namespace testing;

/// x decays, at other rates after each event of a clock: 1 up to a, 3 from then on, 2 after b^2 if that comes, until
/// the clock is set back after a time 2 and x gains 1.
/// @param watched in the second mode; @param next of the first event, as TOML
Model timed(const std::string& first_watched, const std::string& second_watched, const std::string& next) {
    return model_from(fmt::format(R"toml(
[parameters]
a = 0.5
b = 1
g = 0.2
[states]
x = 1
c = 0
[modes.first]
rates = {{ x = "-x", c = 1 }}
watch = [{}]
[modes.second]
rates = {{ x = "-3*x", c = 1 }}
watch = [{}]
[modes.third]
rates = {{ x = "-2*x", c = 1 }}
watch = ["set_back"]
[events.early]
function = "a - c"
[events.late]
function = "b^2 - c"
[events.set_back]
function = "2 - c"
[jumps.stay]
[jumps.reset]
x = "x + 1"
c = 0
[[transitions]]
mode = "first"
event = "early"
jump = "stay"
next = {}
label = "A"
[[transitions]]
mode = "first"
event = "late"
jump = "stay"
next = "third"
label = "D"
[[transitions]]
mode = "second"
event = "late"
jump = "stay"
next = "third"
label = "B"
[[transitions]]
mode = "second"
event = "set_back"
jump = "reset"
next = "first"
label = "E"
[[transitions]]
mode = "third"
event = "set_back"
jump = "reset"
next = "first"
label = "C"
[initial]
mode = "first"
)toml",
                                  first_watched, second_watched, next));
}

/// x after it has gained 1, where it decays by so much in between.
double start_of(double decay) {
    return 1 / (1 - std::exp(-decay));
}

/// The branch in a, up to its only point of this type.
SpecialPoint found(const Model& model, const std::string& signature, std::vector<std::vector<double>> starts,
                   std::vector<double> durations, PointType type) {
    BranchSettings settings = in_parameter(model, "a", 0.1, 1.5);
    settings.stop_at = {type};
    const Orbit orbit{
        parse_signature(model, signature), model.parameter_values(), std::move(starts), std::move(durations), {}};
    const Branch branch = follow_branch(model, orbit, settings);
    EXPECT_EQ(branch.outcome, BranchOutcome::stopped) << names(branch) << branch.detail;
    return branch.special.empty() ? SpecialPoint{} : branch.special.back();
}

TEST(OrderCurves, of_two_events_at_once_have_their_closed_form) {
    // After the first event the later one is watched no more: orbits are A E as long as a < b^2.
    const Model model = timed("\"early\", \"late\"", "\"set_back\"", "\"second\"");
    const double x = start_of(0.5 + 3 * 1.5);
    const SpecialPoint point =
        found(model, "A E", {{x, 0}, {x * std::exp(-0.5), 0.5}}, {0.5, 1.5}, PointType::two_events);
    EXPECT_NEAR(point.parameter, 1, 1e-12);
    EXPECT_EQ(point.detail, "late");
    for (const int way : {1, -1}) {
        const Branch curve = curve_of(model, point, in_parameter(model, "a", 0.1, 1.5), "b", 0.5, 1.3, way);
        EXPECT_EQ(names(curve), "BD") << curve.detail;
        ASSERT_GT(curve.points.size(), 5U);
        for (const BranchPoint& one : curve.points) {
            const double b = value_of(model, one.solution, "b"), a = one.parameter;
            EXPECT_NEAR(a, b * b, 1e-12);
            EXPECT_NEAR(one.solution.orbit.starts[0][0], start_of(a + 3 * (2 - a)), 1e-11);
            EXPECT_TRUE(one.solution.certificate.admissible) << one.solution.certificate.reason;
        }
    }
}

TEST(OrderCurves, of_vanishing_segments_have_their_closed_form) {
    const Model model = timed("\"early\"", "\"late\", \"set_back\"", "\"second\"");
    const double x = start_of(0.5 + 3 * 0.5 + 2 * 1);
    const SpecialPoint point = found(model, "A B C", {{x, 0}, {x * std::exp(-0.5), 0.5}, {x * std::exp(-2), 1}},
                                     {0.5, 0.5, 1}, PointType::vanishing);
    EXPECT_NEAR(point.parameter, 1, 1e-12);
    EXPECT_EQ(point.detail.substr(0, 9), "segment 2");
    for (const int way : {1, -1}) {
        const Branch curve = curve_of(model, point, in_parameter(model, "a", 0.1, 1.5), "b", 0.5, 1.3, way);
        EXPECT_EQ(names(curve), "BD") << curve.detail;
        ASSERT_GT(curve.points.size(), 5U);
        for (const BranchPoint& one : curve.points) {
            const double b = value_of(model, one.solution, "b"), a = one.parameter;
            EXPECT_NEAR(a, b * b, 1e-12);
            EXPECT_NEAR(one.solution.orbit.durations[1], 0, 1e-12);
            EXPECT_NEAR(one.solution.orbit.starts[0][0], start_of(a + 2 * (2 - a)), 1e-11);
            EXPECT_TRUE(one.solution.certificate.admissible) << one.solution.certificate.reason;
        }
    }
}

TEST(OrderCurves, of_guards_about_to_change_have_their_closed_form) {
    // Whether x exceeds g when the first event comes decides what follows.
    const Model model =
        timed("\"early\"", "\"set_back\"", R"([{ when = "x - g > 0", mode = "second" }, { mode = "third" }])");
    const auto level = [](double a) { return std::exp(-a) * start_of(a + 3 * (2 - a)); };
    const double x = start_of(0.5 + 3 * 1.5);
    Model with = model;
    with.set_parameter("g", level(1));
    const SpecialPoint point = found(with, "A E", {{x, 0}, {x * std::exp(-0.5), 0.5}}, {0.5, 1.5}, PointType::guard);
    EXPECT_NEAR(point.parameter, 1, 1e-11);
    for (const int way : {1, -1}) {
        const Branch curve = curve_of(with, point, in_parameter(with, "a", 0.1, 1.5), "g", 0.05, 3, way);
        EXPECT_EQ(names(curve), "BD") << curve.detail;
        ASSERT_GT(curve.points.size(), 5U);
        for (const BranchPoint& one : curve.points) {
            EXPECT_NEAR(value_of(with, one.solution, "g"), level(one.parameter), 1e-11);
            EXPECT_TRUE(one.solution.certificate.admissible) << one.solution.certificate.reason;
        }
    }
}

} // namespace
} // namespace graze
