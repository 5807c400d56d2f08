// Starts, ends and step lengths of branches, which must not change the points found.

#include "base/message_of.hpp"
#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace graze::orbit_branch_test {

using namespace graze::testing;

/// An impact oscillator with one impact per period of the force.
struct OneImpact {
    Model model = shipped_with("impact-oscillator", {{"zeta", 0.05}, {"omega", 2.4}, {"sigma", 0.02}, {"e", 0.7}});
    Orbit orbit = settled(model, "phase0", 400).orbit;
    BranchSettings settings = in_parameter(model, "sigma", -1, 1);
};

TEST(OrbitBranch, FindsTheSamePointsFromBothEnds) {
    OneImpact one;
    const Branch up = follow_branch(System(one.model), one.orbit, one.settings);
    one.settings.direction = -1;
    const Branch down = follow_branch(System(one.model), one.orbit, one.settings);
    ASSERT_EQ(names(up), "PD GR");
    ASSERT_EQ(names(down), "SN GR");
    // From near the one end to the other. The one in the middle is where it began.
    std::vector<double> expected;
    for (const Branch* branch : {&down, &up})
        for (const SpecialPoint& point : branch->special)
            expected.push_back(point.parameter);
    std::sort(expected.begin(), expected.end());
    const Orbit& end = up.points[up.points.size() - 2].solution.orbit;
    const Branch all = follow_branch(System(one.model), end, one.settings);
    ASSERT_EQ(names(all), "PD SN GR");
    EXPECT_NEAR(all.special[0].parameter, up.special[0].parameter, 1e-13);
    EXPECT_NEAR(all.special[1].parameter, down.special[0].parameter, 1e-13);
    EXPECT_NEAR(all.special[2].parameter, down.special[1].parameter, 1e-13);
}

TEST(OrbitBranch, PointsDoNotDependOnStepLengths) {
    OneImpact one;
    one.settings.direction = -1;
    const Branch reference = follow_branch(System(one.model), one.orbit, one.settings);
    for (const double first : {1e-4, 1e-3, 0.03, 0.3})
        for (const double largest : {0.02, 0.1, 0.4}) {
            one.settings.continuation.first_step = first;
            one.settings.continuation.largest_step = largest;
            one.settings.steps = 5000;
            const Branch branch = follow_branch(System(one.model), one.orbit, one.settings);
            ASSERT_EQ(names(branch), names(reference)) << first << ' ' << largest;
            for (std::size_t i = 0; i < branch.special.size(); ++i) {
                EXPECT_NEAR(branch.special[i].parameter, reference.special[i].parameter, 1e-12);
                for (std::size_t k = 0; k < 2; ++k)
                    EXPECT_NEAR(branch.special[i].solution.orbit.starts[0][k],
                                reference.special[i].solution.orbit.starts[0][k], 1e-10);
            }
        }
}

TEST(OrbitBranch, EndsOnItsBounds) {
    OneImpact one;
    for (const int direction : {1, -1}) {
        one.settings.direction = direction;
        one.settings.least = -0.1;
        one.settings.greatest = 0.05;
        const Branch branch = follow_branch(System(one.model), one.orbit, one.settings);
        EXPECT_EQ(branch.outcome, BranchOutcome::bound);
        ASSERT_EQ(names(branch), "BD");
        const double bound = direction > 0 ? 0.05 : -0.1;
        EXPECT_EQ(branch.special[0].parameter, bound);
        EXPECT_EQ(branch.points.back().parameter, bound);
        EXPECT_EQ(branch.points.back().solution.orbit.parameters[one.settings.parameter.place()], bound);
        EXPECT_LT(branch.special[0].solution.residual, 1e-11);
        // From a point on the bound, the branch ends at once in one direction and continues in the other.
        one.settings.least = direction > 0 ? -0.1 : 0.02;
        one.settings.greatest = direction > 0 ? 0.02 : 0.05;
        const Branch none = follow_branch(System(one.model), one.orbit, one.settings);
        EXPECT_EQ(none.outcome, BranchOutcome::bound);
        EXPECT_EQ(none.points.size(), 1U);
        one.settings.direction = -direction;
        const Branch back = follow_branch(System(one.model), one.orbit, one.settings);
        EXPECT_EQ(back.outcome, BranchOutcome::bound);
        EXPECT_GT(back.points.size(), 2U);
        EXPECT_EQ(back.points.back().parameter, direction > 0 ? -0.1 : 0.05);
    }
}

TEST(OrbitBranch, StopsAtRequestedTypes) {
    OneImpact one;
    one.settings.stop_at = {PointType::flip};
    const Branch branch = follow_branch(System(one.model), one.orbit, one.settings);
    EXPECT_EQ(branch.outcome, BranchOutcome::stopped);
    ASSERT_EQ(names(branch), "PD");
    EXPECT_EQ(branch.points.back().parameter, branch.special[0].parameter);
    one.settings.stop_at = {};
    one.settings.steps = 7;
    const Branch few = follow_branch(System(one.model), one.orbit, one.settings);
    EXPECT_EQ(few.outcome, BranchOutcome::steps);
    EXPECT_EQ(few.points.size(), 8U);
    one.settings.steps = 0;
    EXPECT_EQ(follow_branch(System(one.model), one.orbit, one.settings).points.size(), 1U);
    one.settings.steps = 100;
    std::size_t seen = 0;
    const Branch visited = follow_branch(System(one.model), one.orbit, one.settings,
                                         [&](const BranchPoint&, const auto&) { return ++seen < 4; });
    EXPECT_EQ(visited.outcome, BranchOutcome::stopped);
    EXPECT_EQ(visited.points.size(), 4U);
}

TEST(OrbitBranch, MayContinueThroughInadmissibleOrbits) {
    OneImpact one;
    one.settings.stop_when_unphysical = false;
    one.settings.steps = 1000;
    const Branch branch = follow_branch(System(one.model), one.orbit, one.settings);
    const auto grazings = of_type(branch, PointType::grazing);
    ASSERT_GE(grazings.size(), 1U);
    EXPECT_TRUE(grazings[0].at_end);
    // All solutions lie on a closed curve with inadmissible parts.
    EXPECT_EQ(branch.outcome, BranchOutcome::closed) << branch.detail;
    std::size_t possible = 0;
    const Simulation simulation{System(one.model)};
    for (const BranchPoint& point : branch.points) {
        // Simulation follows exactly the admissible ones.
        const Orbit& orbit = point.solution.orbit;
        const bool leaves = orbit.starts[0][1] < 0;
        const FollowedMotion motion =
            follow_motion(simulation, orbit.parameters, orbit.starts[0], 0, 1.001 * orbit.period());
        const bool real = leaves && !motion.durations.empty() && std::abs(motion.durations[0] - orbit.period()) < 1e-6;
        EXPECT_EQ(point.solution.certificate.admissible, real) << point.step;
        EXPECT_EQ(point.solution.certificate.reason.empty(), real);
        possible += real ? 1 : 0;
    }
    EXPECT_GT(possible, 10U);
    EXPECT_LT(possible + 10, branch.points.size());
}

TEST(OrbitBranch, CanBeStoppedAndResumed) {
    OneImpact one;
    const Branch whole = follow_branch(System(one.model), one.orbit, one.settings);
    OrbitBranch first(System(one.model), one.orbit, one.settings);
    ASSERT_TRUE(first.start());
    std::size_t step = 0;
    const auto compare = [&](const OrbitBranch& branch) {
        EXPECT_EQ(branch.point().solution.orbit.starts, whole.points[step].solution.orbit.starts);
        EXPECT_EQ(branch.point().parameter, whole.points[step].parameter);
        EXPECT_EQ(branch.point().arclength, whole.points[step].arclength);
        EXPECT_EQ(branch.point().solution.multipliers, whole.points[step].solution.multipliers);
    };
    for (; step < 10; ++step, first.step())
        compare(first);
    OrbitBranch moved(std::move(first)); // bit for bit as if it had not been stopped
    while (moved.step())
        ++step, compare(moved);
    EXPECT_EQ(step + 1, whole.points.size());
    EXPECT_FALSE(moved.step());
    EXPECT_EQ(moved.outcome(), whole.outcome);
}

TEST(OrbitBranch, SixtySegmentsGiveTheSamePointsAsOne) {
    OneImpact one;
    one.settings.direction = -1;
    const Branch single = follow_branch(System(one.model), one.orbit, one.settings);
    Orbit many = one.orbit;
    many.signature = parse_signature(one.model, "impact^60");
    many.starts.assign(60, one.orbit.starts[0]);
    many.durations.assign(60, one.orbit.durations[0]);
    one.settings.continuation.largest_step = 0.5; // lengths of steps are sums over all segments
    const Branch branch = follow_branch(System(one.model), many, one.settings);
    const auto folds = of_type(branch, PointType::fold);
    ASSERT_EQ(folds.size(), 1U);
    EXPECT_NEAR(folds[0].parameter, single.special[0].parameter, 1e-11);
    ASSERT_GT(branch.points.size(), 3U);
    EXPECT_NEAR(std::abs(branch.points[0].solution.multipliers[0]),
                std::pow(std::abs(single.points[0].solution.multipliers[0]), 60), 1e-10);
    EXPECT_LT(branch.points.back().solution.residual, 1e-11);
}

TEST(OrbitBranch, WrongSettingsAreRefused) {
    const OneImpact one;
    const auto refused = [&](const std::function<void(BranchSettings&)>& change) {
        BranchSettings settings = one.settings;
        change(settings);
        return message_of([&] { follow_branch(System(one.model), one.orbit, settings); });
    };
    EXPECT_NE(refused([](auto& s) { s.direction = 0; }).find("direction"), std::string::npos);
    EXPECT_NE(refused([](auto& s) { s.parameter = ParameterId(99); }).find("parameter"), std::string::npos);
    EXPECT_NE(refused([](auto& s) { s.least = 2; }).find("bounds"), std::string::npos);
    EXPECT_NE(refused([](auto& s) { s.least = 0.5; }).find("outside the branch's bounds"), std::string::npos);
    EXPECT_NE(refused([](auto& s) { s.greatest = NAN; }).find("bound"), std::string::npos);
    EXPECT_NE(refused([](auto& s) { s.continuation.first_step = 0; }).find("step"), std::string::npos);
    EXPECT_NE(refused([](auto& s) { s.continuation.largest_step = INFINITY; }).find("step"), std::string::npos);
    EXPECT_NE(refused([](auto& s) { s.orbit.tolerance = 1; }).find("tolerance"), std::string::npos);
    Orbit wrong = one.orbit;
    wrong.starts[0].pop_back();
    EXPECT_NE(message_of([&] { follow_branch(System(one.model), wrong, one.settings); }).find("states"),
              std::string::npos);
    OrbitBranch branch(System(one.model), one.orbit, one.settings);
    EXPECT_NE(message_of([&] { branch.start_along({{{1, 2}}, {1}, {}}, 0.1); }).find("direction"), std::string::npos);
    EXPECT_FALSE(branch.step());
    // A candidate from which no orbit is found.
    wrong = one.orbit;
    wrong.starts[0] = {0.02, -300, 0};
    wrong.durations[0] = 1e-3;
    const Branch none = follow_branch(System(one.model), wrong, one.settings);
    if (none.points.empty()) {
        EXPECT_EQ(none.outcome, BranchOutcome::no_start);
        EXPECT_FALSE(none.detail.empty());
    }
}

TEST(OrbitBranch, PointsWithoutOtherBranchesAreRefused) {
    const OneImpact one;
    BranchSettings settings = one.settings;
    settings.direction = -1;
    const Branch branch = follow_branch(System(one.model), one.orbit, settings);
    EXPECT_NE(message_of([&] { branches_at(System(one.model), branch.special.at(0), settings); }).find("SN"),
              std::string::npos);
    settings.direction = 1;
    settings.greatest = 0.05;
    const Branch bounded = follow_branch(System(one.model), one.orbit, settings);
    EXPECT_NE(message_of([&] { branches_at(System(one.model), bounded.special.at(0), settings); }).find("BD"),
              std::string::npos);
}

/// An oscillator with a stop, and an independent u' = u (p - u^2) whose branches cross at p = 0. The impact disappears
/// at p = lost, where the stop is out of reach.
Model pitchfork_beside_impacts(double lost) {
    const double reach = 1 / std::hypot(1 - 2.4 * 2.4, 2 * 0.05 * 2.4);
    return OneMode{.parameters = fmt::format("p = 0.3\nreach = {:.17g}\nlost = {:.17g}", reach, lost),
                   .states = "x = 0\nv = 0\ny = 1",
                   .definitions = "u = 'y - cos(theta)'",
                   .rates = "x = 'v', v = 'cos(theta) - 0.1*v - x', y = '2.4*(u*(p - u^2) - sin(theta))'",
                   .clock = "2.4",
                   .stops = {{"stop", "reach + p - lost - x", "v = '-0.7*v'", "impact"}}}
        .model();
}

TEST(OrbitBranch, CrossingNearAVanishingContactIsKept) {
    for (const double lost : {-3e-4, 1e-4, 3e-4, 6e-4}) {
        const Model model = pitchfork_beside_impacts(lost);
        BranchSettings settings = in_parameter(model, "p");
        // The orbit without impacts touches the stop there, and the branch with one impact begins there.
        Orbit trivial = settled(model, "start").orbit;
        trivial.starts[0][2] = std::cos(trivial.starts[0][3]);
        settings.direction = -1;
        settings.stop_at = {PointType::grazing};
        const Branch without = follow_branch(System(model), trivial, settings);
        ASSERT_FALSE(without.special.empty());
        const SpecialPoint grazing = without.special.back();
        ASSERT_EQ(grazing.type, PointType::grazing);
        settings.stop_at = {};
        settings.steps = 40;
        settings.reorder = false;
        const Branch impacting = follow(model, branches_at(System(model), grazing, settings).at(0), settings);
        ASSERT_GT(impacting.points.size(), 10U);
        EXPECT_LT(impacting.points.back().parameter, -1e-3);
        // Back to where the impact disappears, with different step lengths.
        for (const double step : {0.02, 0.05}) {
            settings.continuation.largest_step = step;
            settings.steps = 1000;
            const BranchPoint& far = impacting.points.back();
            OrbitBranch back(System(model), far.solution.orbit, settings);
            OrbitDirection direction = far.tangent;
            for (std::vector<double>* numbers : {&direction.starts[0], &direction.durations, &direction.parameters})
                for (double& one : *numbers)
                    one = -one;
            std::string found;
            for (bool going = back.start_along(direction, 0); going; going = back.step())
                for (const SpecialPoint& special : back.found()) {
                    found += std::string(short_name(special.type)) + " ";
                    if (special.type == PointType::branch_point) {
                        EXPECT_NEAR(special.parameter, 0, 1e-7);
                    }
                    if (special.type == PointType::grazing) {
                        EXPECT_NEAR(special.parameter, lost, 1e-10);
                        const OrbitSolution again = solve_orbit(System(model), special.solution.orbit);
                        EXPECT_TRUE(again.multipliers.empty()); // they diverge at zero speed
                    }
                }
            EXPECT_NE(found.find("GR"), std::string::npos) << lost;
            EXPECT_EQ(found.find("BP") != std::string::npos, far.parameter * lost < 0) << lost << ' ' << found;
        }
    }
}

} // namespace graze::orbit_branch_test
