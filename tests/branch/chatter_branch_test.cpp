// Branches of orbits with complete chatter sequences, and their ends.

#include "follow.hpp"
#include "orbit/kicked_ball.hpp"
#include "trajectory/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace graze::chatter_branch_test {

using namespace graze::testing;

constexpr double omega_of_table = 20 * std::numbers::pi;

Model ball(double a) {
    return shipped_with("bouncing-ball", {{"a", a}, {"e", 0.5}});
}

Model oscillator(double omega) {
    return shipped_with("impact-oscillator", {{"omega", omega}, {"e", 0.5}, {"sigma", -0.5}});
}

/// Times of the first accumulation of contacts and of the first release, of the motion from a state at rest; 0: none.
struct Times {
    double accumulation = 0, release = 0;
};
Times simulated(const Model& model, const std::vector<double>& state, double time) {
    Experiment experiment(model);
    experiment.run_from(state, 1, time);
    Times times;
    for (const Recorder::RecordedContact& one : experiment.recorder.contacts()) {
        if (one.contact.kind == ContactKind::sticking && times.accumulation == 0)
            times.accumulation = one.contact.time;
        if (one.contact.kind == ContactKind::crossing && times.release == 0)
            times.release = one.contact.time;
    }
    return times;
}

TEST(ChatterBranch, OfAKickedBallEndsWhereItsRestVanishes) {
    const KickedBall ball;
    const Model model = ball.model();
    const auto start = orbit_with_signature(System(model), parse_signature(model, "impact* kick"));
    ASSERT_TRUE(start);
    const Branch branch = follow_branch(System(model), start->orbit, in_parameter(model, "V", 0.1, 4));
    ASSERT_FALSE(branch.points.empty()) << branch.detail;
    // Flights take 2V/(g (1 - e)) in all.
    const OrbitDirection& tangent = branch.points[0].tangent;
    EXPECT_NEAR(tangent.durations[0] / tangent.parameters[0], 0.4, 1e-11);
    EXPECT_NEAR(tangent.durations[1] / tangent.parameters[0], -0.4, 1e-11);
    for (const BranchPoint& point : branch.points) {
        EXPECT_NEAR(point.solution.orbit.durations[0], 0.4 * point.parameter, 1e-12);
        EXPECT_TRUE(point.stable);
    }
    ASSERT_EQ(branch.special.size(), 1U);
    EXPECT_EQ(branch.special[0].type, PointType::vanishing);
    EXPECT_NEAR(branch.special[0].parameter, 2.5, 1e-9);
    EXPECT_EQ(branch.outcome, BranchOutcome::unphysical);
    // The curve of such points in two parameters: 2V = g (1 - e).
    const Branch curve = curve_of(model, branch.special[0], in_parameter(model, "V", 0.1, 4), "e", 0.1, 0.8, 1);
    EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
    EXPECT_GT(curve.points.size(), 5U);
    for (const BranchPoint& point : curve.points)
        EXPECT_NEAR(point.parameter, 5 * (1 - value_of(model, point.solution, "e")), 1e-10);
}

TEST(ChatterBranch, HasTheTangentOfAComputationInFortyDigits) {
    const Model model = ball(0.003);
    const OrbitSolution start = settled(model, "phase0");
    for (const auto& [name, by] : {std::pair{"a", 49.2766399467152}, std::pair{"e", 0.0432215714033876}}) {
        BranchSettings settings = in_parameter(model, name);
        settings.steps = 1;
        const Branch branch = follow_branch(System(model), start.orbit, settings);
        ASSERT_FALSE(branch.points.empty());
        const OrbitDirection& tangent = branch.points[0].tangent;
        EXPECT_NEAR(tangent.durations[0] / tangent.parameters[0], by, 1e-8 * by) << name;
    }
}

TEST(ChatterBranch, AgreesWithSimulationAllAlong) {
    const Model model = oscillator(0.5);
    const OrbitSolution start = settled(model, "phase0");
    const Branch branch = follow_branch(System(model), start.orbit, in_parameter(model, "e", 0.05, 0.77, -1));
    EXPECT_EQ(branch.outcome, BranchOutcome::bound) << branch.detail;
    for (std::size_t i = 0; i < branch.points.size(); i += 4) {
        const Orbit& orbit = branch.points[i].solution.orbit;
        EXPECT_TRUE(branch.points[i].solution.certificate.admissible);
        Model there = model;
        there.set_parameter("e", branch.points[i].parameter);
        const Times times = simulated(there, orbit.starts[1], 1.01 * orbit.period());
        EXPECT_NEAR(times.release, orbit.durations[1], 1e-9);
        EXPECT_NEAR(times.accumulation, orbit.period(), 1e-9) << branch.points[i].parameter;
        for (const auto& multiplier : branch.points[i].solution.multipliers)
            EXPECT_EQ(std::abs(multiplier), 0);
    }
}

TEST(ChatterBranch, EndsAtTheOnsetOfChatter) {
    Model model = oscillator(0.5);
    const OrbitSolution start = settled(model, "phase0");
    const Branch branch = follow_branch(System(model), start.orbit, in_parameter(model, "omega", 0.2, 2));
    EXPECT_EQ(branch.outcome, BranchOutcome::unphysical);
    ASSERT_FALSE(branch.special.empty());
    const SpecialPoint& end = branch.special.back();
    ASSERT_EQ(end.type, PointType::chatter) << end.detail;
    EXPECT_LT(end.bracket.second - end.bracket.first, 1e-9);
    // The rest vanishes there.
    const BranchPoint& last = branch.points[branch.points.size() - 2];
    EXPECT_NEAR(last.parameter, end.parameter, 1e-7);
    EXPECT_LT(last.solution.orbit.durations[1], 1e-4);
    EXPECT_TRUE(last.stable);
    // A motion that leaves the stop at the place of the release comes to rest before one period is over, or not at all.
    for (const double side : {-1e-4, 1e-4}) {
        const double omega = end.parameter + side;
        model.set_parameter("omega", omega);
        const double period = 2 * std::numbers::pi / omega, release = std::acos(-0.5);
        const Times times = simulated(model, {-0.5, 0, release - 1e-3}, 1.001 * period);
        EXPECT_EQ(times.accumulation > 0 && times.accumulation < period + 1e-3 / omega, side < 0) << omega;
    }
}

TEST(ChatterBranch, EndsAtAnOnsetThatIsTooFarToBeFollowed) {
    // With a restitution of 0.77 the motion of the onset has too many contacts: the end is extrapolated.
    Model model = oscillator(0.5);
    const OrbitSolution start = settled(model, "phase0");
    const Branch branch = follow_branch(System(model), start.orbit, in_parameter(model, "e", 0.05, 0.95));
    EXPECT_EQ(branch.outcome, BranchOutcome::unphysical);
    ASSERT_FALSE(branch.special.empty());
    const SpecialPoint& end = branch.special.back();
    ASSERT_EQ(end.type, PointType::chatter) << end.detail;
    EXPECT_FALSE(end.located);
    for (const double side : {-1e-5, 1e-5}) {
        model.set_parameter("e", end.parameter + side);
        const double period = 4 * std::numbers::pi, release = std::acos(-0.5);
        const Times times = simulated(model, {-0.5, 0, release - 1e-3}, 1.001 * period);
        EXPECT_EQ(times.accumulation > 0 && times.accumulation < period + 2e-3, side < 0) << side;
    }
}

TEST(ChatterBranch, FollowsSequencesOfManySlowContacts) {
    // Near e = 0.87 some seventy contacts are resolved; the last flights are a hundred-thousandth of the first.
    const double least = 9.81 / (omega_of_table * omega_of_table);
    Model model = ball(least / 0.9);
    model.set_parameter("e", 0.4);
    const OrbitSolution start = settled(model, "phase0");
    const Branch branch = follow_branch(System(model), start.orbit, in_parameter(model, "e", 0.3, 0.88, 1));
    EXPECT_EQ(branch.outcome, BranchOutcome::bound) << branch.detail;
    for (const BranchPoint& point : branch.points) {
        EXPECT_TRUE(point.solution.certificate.admissible) << point.parameter << point.solution.certificate.reason;
        EXPECT_TRUE(point.stable) << point.parameter; // contacts that accumulate forget the start
    }
}

TEST(ChatterBranch, EndsWhereTheBallNoLongerLeavesTheTable) {
    // The table's greatest acceleration is a omega^2.
    const double least = 9.81 / (omega_of_table * omega_of_table);
    const Model model = ball(0.003);
    const OrbitSolution start = settled(model, "phase0");
    const Branch branch = follow_branch(System(model), start.orbit, in_parameter(model, "a", 0.001, 0.006, -1));
    EXPECT_EQ(branch.outcome, BranchOutcome::unphysical) << branch.detail;
    ASSERT_FALSE(branch.special.empty());
    const SpecialPoint& end = branch.special.back();
    EXPECT_EQ(end.type, PointType::vanishing);
    EXPECT_FALSE(end.located); // it is extrapolated
    EXPECT_NEAR(end.parameter, least, 1e-8);
    EXPECT_EQ(value_of(model, end.solution, "a"), end.parameter);
    EXPECT_GE(least, end.bracket.first);
    EXPECT_LE(least, end.bracket.second);
}

TEST(ChatterBranch, EndsWhereTheFirstContactHasNoSpeed) {
    // A flight from a lift-off at the phase p to the phase 3 pi - p, at the same height, where the table's acceleration
    // is -g again. Whatever the restitution, the ball returns without speed where 2 a omega cos(p) is g times the time.
    constexpr double exact = 0.0114388460446474;
    for (const double e : {0.1, 0.3}) {
        const Model model = shipped_with("bouncing-ball", {{"a", 0.012}, {"e", e}});
        const OrbitSolution start = settled(model, "phase0");
        const Branch branch = follow_branch(System(model), start.orbit, in_parameter(model, "a", 0.001, 0.05, -1));
        EXPECT_EQ(branch.outcome, BranchOutcome::unphysical) << branch.detail;
        ASSERT_FALSE(branch.special.empty());
        const SpecialPoint& end = branch.special.back();
        ASSERT_EQ(end.type, PointType::grazing) << end.detail;
        EXPECT_FALSE(end.located);
        EXPECT_NEAR(end.parameter, exact, 1e-8);
        EXPECT_GE(exact, end.bracket.first) << e;
        EXPECT_LE(exact, end.bracket.second) << e;
    }
}

TEST(ChatterBranch, EndsWhereAFlightTouchesTheTable) {
    const Model model = shipped_with("bouncing-ball", {{"a", 0.03}, {"e", 0.2}});
    const OrbitSolution start = settled(model, "phase0");
    const Branch branch = follow_branch(System(model), start.orbit, in_parameter(model, "a", 0.02, 0.04, -1));
    EXPECT_EQ(branch.outcome, BranchOutcome::unphysical);
    ASSERT_EQ(branch.special.size(), 1U);
    const SpecialPoint& end = branch.special[0];
    ASSERT_EQ(end.type, PointType::grazing);
    EXPECT_TRUE(end.located);
    // The simulated motion touches the table there, at that time.
    double least = 1;
    for (const OrbitMinimum& one : end.solution.certificate.minima)
        if (one.segment == end.segment && one.time == end.time)
            least = one.value;
    EXPECT_NEAR(least, 0, 1e-9);
    for (const double side : {-1e-10, 1e-10}) {
        Model there = model;
        there.set_parameter("a", end.parameter + side);
        Experiment experiment(there);
        const Orbit& orbit = end.solution.orbit;
        const std::size_t rest = 1 - end.segment;
        const double time = orbit.durations[rest] + end.time;
        experiment.run_from(orbit.starts[rest], 1, 1.01 * time);
        const auto& contacts = experiment.recorder.contacts();
        const bool touches = std::ranges::any_of(contacts, [&](const Recorder::RecordedContact& one) {
            return one.contact.kind == ContactKind::crossing && std::abs(one.contact.time - time) < 5e-3;
        });
        EXPECT_EQ(touches, side < 0) << side;
    }
}

} // namespace graze::chatter_branch_test
