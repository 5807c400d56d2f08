// Curves of simultaneous events, vanishing segments and changing guards, with closed forms.

#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace graze::order_curves_test {

using namespace graze::testing;

/// x decays at rates that change with events of a clock: 1 up to time a, then 3, and 2 after b^2 if that event happens,
/// until the clock is reset at time 2 and x increases by 1.
/// @param watched events watched in the second mode; @param next mode after the first event, as TOML
Model timed(const std::string& first_watched, const std::string& second_watched, const std::string& next) {
    return model_from(
        fmt::format(R"toml(
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
[events]
early = "a - c"
late = "b^2 - c"
set_back = "2 - c"
[jumps.stay]
[jumps.reset]
x = "x + 1"
c = 0
[initial]
mode = "first"
)toml",
                    first_watched, second_watched) +
        transition("first", "early", next, "stay", "A") + transition("first", "late", "third", "stay", "D") +
        transition("second", "late", "third", "stay", "B") + transition("second", "set_back", "first", "reset", "E") +
        transition("third", "set_back", "first", "reset", "C"));
}

/// Returns x after its increase by 1, from the total decay in between.
double start_of(double decay) {
    return 1 / (1 - std::exp(-decay));
}

/// Follows the branch in a to its only point of this type.
SpecialPoint found(const Model& model, const std::string& signature, std::vector<std::vector<double>> starts,
                   std::vector<double> durations, PointType type) {
    BranchSettings settings = in_parameter(model, "a", 0.1, 1.5);
    settings.stop_at = {type};
    const Orbit orbit = given_orbit(model, signature, std::move(starts), std::move(durations));
    const Branch branch = follow_branch(System(model), orbit, settings);
    EXPECT_EQ(branch.outcome, BranchOutcome::stopped) << names(branch) << branch.detail;
    return branch.special.empty() ? SpecialPoint{} : branch.special.back();
}

TEST(OrderCurves, SimultaneousEventsHaveTheirClosedForm) {
    // After the first event the later one is not watched: orbits are A E as long as a < b^2.
    const Model model = timed("\"early\", \"late\"", "\"set_back\"", "second");
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

TEST(OrderCurves, VanishingSegmentsHaveTheirClosedForm) {
    const Model model = timed("\"early\"", "\"late\", \"set_back\"", "second");
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

TEST(OrderCurves, ChangingGuardsHaveTheirClosedForm) {
    // The next mode depends on whether x exceeds g at the first event.
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

/// x'' + 0.2 x' + x = F cos(c) with the phase c, reset at 2 pi, and two events that change the motion of y: at the
/// phase 0.5 and at 0.3 omega. The stop is only touched, at a phase above 2.
Model touching_among_events() {
    std::string text = R"toml(
[parameters]
F = 0.3
omega = 1.3
d = 1
[states]
x = 0
v = 0
y = 1
c = 0
[events]
stop = "d - x"
fixed = "0.5 - c"
moving = "0.3*omega - c"
round = "2*pi - c"
[jumps.impact]
v = "-0.8*v"
[jumps.one]
y = "y + 1"
[jumps.half]
y = "y/2"
[jumps.reset]
c = "c - 2*pi"
[initial]
mode = "neither"
)toml" + section("late", "c - 3");
    const auto mode = [&](const std::string& name, const std::string& watched) {
        text += fmt::format("[modes.{}]\nrates = {{ x = \"v\", v = \"F*cos(c) - 0.2*v - x\", y = \"-y\", c = \"omega\" "
                            "}}\nwatch = [\"stop\", {}]\n",
                            name, watched);
    };
    const auto add = [&](const std::string& from, const std::string& event, const std::string& jump,
                         const std::string& next,
                         const std::string& label) { text += transition(from, event, next, jump, label); };
    mode("neither", "\"fixed\", \"moving\"");
    mode("one", "\"moving\"");
    mode("other", "\"fixed\"");
    mode("both", "\"round\"");
    for (const char* name : {"neither", "one", "other", "both"})
        add(name, "stop", "impact", name, fmt::format("hit_{}", name));
    add("neither", "fixed", "one", "one", "A");
    add("neither", "moving", "half", "other", "B");
    add("one", "moving", "half", "both", "C");
    add("other", "fixed", "one", "both", "D");
    add("both", "round", "reset", "neither", "R");
    return model_from(text);
}

TEST(OrderCurves, TouchesContinueWhereOtherEventsChangeTheirOrder) {
    const Model model = touching_among_events();
    const auto force = [](double omega) { return std::hypot(1 - omega * omega, 0.2 * omega); };
    const OrbitSolution start = settled(model, "late", 400);
    BranchSettings settings = in_parameter(model, "F", 0.1, 5);
    const Branch branch = follow_branch(System(model), start.orbit, settings);
    const auto touches = of_type(branch, PointType::grazing);
    ASSERT_EQ(touches.size(), 1U) << names(branch) << branch.detail;
    EXPECT_NEAR(touches[0].parameter, force(1.3), 1e-11);
    // Above omega = 5/3 the fixed event happens first, below it the moving one.
    const Branch curve = curve_of(model, touches[0], settings, "omega", 0.9, 2.2, 1);
    EXPECT_EQ(curve.outcome, BranchOutcome::bound) << names(curve) << curve.detail;
    std::size_t changes = 0;
    for (const SpecialPoint& one : curve.special)
        if (one.detail.find("goes on as") != std::string::npos) {
            ++changes;
            EXPECT_NEAR(value_of(model, one.solution, "omega"), 5.0 / 3, 1e-11);
        }
    EXPECT_EQ(changes, 1U) << names(curve);
    ASSERT_GT(curve.points.size(), 10U);
    for (const BranchPoint& one : curve.points) {
        const double omega = value_of(model, one.solution, "omega");
        EXPECT_NEAR(one.parameter, force(omega), 1e-10);
        EXPECT_TRUE(one.solution.certificate.admissible) << one.solution.certificate.reason;
    }
    EXPECT_NEAR(value_of(model, curve.points.back().solution, "omega"), 2.2, 1e-12);
    // The touch occurs at the phase of the response, atan2(0.2 omega, 1 - omega^2), which decreases with omega: it
    // passes the fixed event at 0.5 into the segment before it.
    const Branch slower = curve_of(model, touches[0], settings, "omega", 0.1, 2.2, -1);
    EXPECT_EQ(slower.outcome, BranchOutcome::bound) << names(slower) << slower.detail;
    EXPECT_NEAR(value_of(model, slower.points.back().solution, "omega"), 0.1, 1e-12);
    std::size_t before = 0, after = 0;
    for (const BranchPoint& one : slower.points) {
        const double omega = value_of(model, one.solution, "omega");
        EXPECT_NEAR(one.parameter, force(omega), 1e-10);
        ++(std::atan2(0.2 * omega, 1 - omega * omega) < 0.5 ? before : after);
    }
    EXPECT_GT(before, 5U);
    EXPECT_GT(after, 5U);
}

/// A forced oscillator with these stops. The touch of its linear response coincides with the section at omega = 1.5,
/// and precedes it above.
Model with_stops(const std::vector<std::pair<std::string, std::string>>& functions, const std::string& more = {}) {
    std::vector<Stop> stops;
    for (const auto& [name, function] : functions)
        stops.push_back({name, function, "v = '-0.8*v'"});
    return driven("F = 0.3\nomega = 1.3", "F*cos(theta) - 0.2*v - x", "omega", stops,
                  at_phase(std::atan2(0.3, 1 - 1.5 * 1.5)) + more);
}

TEST(OrderCurves, TouchesPassTheSectionOfTheOrbit) {
    const Model model = with_stops({{"stop", "1 - x"}});
    BranchSettings settings = in_parameter(model, "F", 0.1, 5);
    const Branch branch = follow_branch(System(model), settled(model, "start").orbit, settings);
    ASSERT_EQ(names(branch), "GR");
    const Branch curve = curve_of(model, branch.special[0], settings, "omega", 0.9, 2.2, 1);
    ASSERT_EQ(names(curve), "VS BD") << curve.detail; // where half a free oscillation takes a period of the force
    EXPECT_NEAR(value_of(model, curve.special[0].solution, "omega"), 2 * std::sqrt(0.99), 1e-9);
    EXPECT_NEAR(value_of(model, curve.points.back().solution, "omega"), 2.2, 1e-12);
    for (const BranchPoint& one : curve.points) {
        const double omega = value_of(model, one.solution, "omega");
        EXPECT_NEAR(one.parameter, std::hypot(1 - omega * omega, 0.2 * omega), 1e-10);
        EXPECT_TRUE(one.solution.certificate.admissible) << one.solution.certificate.reason;
    }
}

TEST(OrderCurves, TouchesPassTheEndsOfAHalfOrbit) {
    // One stop is touched at the phase of the linear response, the other half a period later.
    const Model model =
        with_stops({{"right", "1 - x"}, {"left", "1 + x"}},
                   "[symmetries.reflection]\nmap = { x = \"-x\", v = \"-v\", theta = \"theta + pi\" }\n");
    BranchSettings settings = in_parameter(model, "F", 0.1, 5);
    const OrbitSolution start = settled(model, "start");
    ASSERT_TRUE(start.orbit.symmetry);
    const Branch branch = follow_branch(System(model), start.orbit, settings);
    ASSERT_EQ(names(branch), "GR");
    const std::string first = branch.special[0].detail;
    const Branch curve = curve_of(model, branch.special[0], settings, "omega", 0.9, 2.2, 1);
    EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
    EXPECT_NEAR(value_of(model, curve.points.back().solution, "omega"), 2.2, 1e-12);
    std::size_t before = 0, after = 0;
    for (const BranchPoint& one : curve.points) {
        const double omega = value_of(model, one.solution, "omega");
        EXPECT_NEAR(one.parameter, std::hypot(1 - omega * omega, 0.2 * omega), 1e-10);
        EXPECT_TRUE(one.solution.certificate.admissible) << one.solution.certificate.reason;
        ++(omega < 1.5 ? before : after);
        // In the half orbit each event is touched on one side of that frequency only.
        for (const OrbitMinimum& minimum : one.solution.certificate.minima) {
            if (std::abs(minimum.value) > 1e-9 || std::abs(omega - 1.5) < 1e-2)
                continue;
            EXPECT_EQ(model.events[minimum.event].name == first, omega < 1.5) << omega;
        }
    }
    EXPECT_GT(before, 3U);
    EXPECT_GT(after, 3U);
}

} // namespace graze::order_curves_test
