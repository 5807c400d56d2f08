// Models with a drifting state: its position must not affect any result.

#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace graze::drifting_test {

using namespace graze::testing;

/// An impact oscillator carried by a frame whose position and velocity do not act on it.
Model carried_oscillator(double zeta, double e, double drift, double by_place, double by_speed, double by_impact) {
    return OneMode{
        .parameters = fmt::format("zeta = {:.17g}\nomega = 2.4\nsigma = 0.02\ne = {:.17g}", zeta, e),
        .states = "x = -1\nv = 0\ns = { initial = 3, drifting = true }",
        .rates = fmt::format("x = 'v', v = 'cos(theta) - 2*zeta*v - x', s = '{:.17g} + {:.17g}*x + {:.17g}*v^2'", drift,
                             by_place, by_speed),
        .clock = "omega",
        .stops = {{"stop", "sigma - x", fmt::format("v = '-e*v'\ns = 's + {:.17g}*v'", by_impact), "impact"}}}
        .model();
}

/// Returns the branch of doubled orbits from the first flip as the stop is moved away.
Branch doubled(const Model& model, SpecialPoint& flip) {
    BranchSettings settings = in_parameter(model, "sigma", -1, 1);
    settings.stop_at = {PointType::flip};
    const Branch branch = follow_branch(System(model), settled(model, "start", 400).orbit, settings);
    if (branch.special.empty() || branch.special.back().type != PointType::flip)
        return {};
    flip = branch.special.back();
    settings.stop_at = {PointType::flip, PointType::fold};
    settings.steps = 60;
    return follow(model, branches_at(System(model), flip, settings).at(0), settings);
}

TEST(Drifting, DoubledOrbitsEqualThoseWithoutDrift) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coefficient(-1, 1), damping(0.04, 0.06), restitution(0.68, 0.72),
        decades(-3, 3);
    for (int trial = 0; trial < 6; ++trial) {
        const double zeta = damping(random), e = restitution(random), size = std::pow(10, decades(random));
        SpecialPoint flip, plain_flip;
        const Branch plain = doubled(carried_oscillator(zeta, e, 0, 0, 0, 0), plain_flip);
        const Branch branch =
            doubled(carried_oscillator(zeta, e, size * coefficient(random), size * coefficient(random),
                                       size * coefficient(random), size * coefficient(random)),
                    flip);
        ASSERT_GT(plain.points.size(), 5U);
        ASSERT_GT(branch.points.size(), 5U) << name_of(branch.outcome) << ' ' << branch.detail;
        EXPECT_NEAR(flip.parameter, plain_flip.parameter, 1e-11);
        EXPECT_NE(branch.outcome, BranchOutcome::returned) << branch.detail;
        ASSERT_EQ(names(branch), names(plain));
        for (std::size_t i = 0; i < branch.special.size(); ++i)
            EXPECT_NEAR(branch.special[i].parameter, plain.special[i].parameter, 1e-10);
        // Impacts are alternately hard and soft. The first point lies about 1e-3 from the flip; orbits that are not
        // doubled would differ by round-off only.
        for (std::size_t k = 1; k < branch.points.size(); ++k) {
            const Orbit& orbit = branch.points[k].solution.orbit;
            ASSERT_EQ(orbit.segments(), 2U);
            EXPECT_GT(std::abs(orbit.starts[0][1] - orbit.starts[1][1]), 1e-4) << k;
        }
        EXPECT_EQ(branch.points.back().solution.multipliers.size(), 2U);
    }
}

TEST(Drifting, MicroactuatorContinuesFromTheFlipWithOneImpact) {
    const Model model = shipped_with("impact-microactuator", {{"V", 0.2}});
    BranchSettings settings = in_parameter(model, "V");
    settings.stop_at = {PointType::grazing};
    const Branch none = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    ASSERT_EQ(none.outcome, BranchOutcome::stopped) << names(none);
    settings.stop_at = {PointType::flip};
    const Branch one = follow(model, branches_at(System(model), none.special.back(), settings).at(0), settings);
    ASSERT_EQ(one.outcome, BranchOutcome::stopped) << names(one);
    EXPECT_NEAR(one.special.back().parameter, 0.85823, 5e-6);
    settings.stop_at = {};
    settings.steps = 40;
    const Branch two = follow(model, branches_at(System(model), one.special.back(), settings).at(0), settings);
    ASSERT_GT(two.points.size(), 10U) << two.detail;
    EXPECT_NE(two.outcome, BranchOutcome::returned);
    EXPECT_EQ(to_string(model, two.points[1].solution.orbit.signature), "(J8 J1)^2");
    for (std::size_t k = 1; k < 10; ++k) {
        const Orbit& orbit = two.points[k].solution.orbit;
        EXPECT_GT(std::abs(orbit.durations[0] - orbit.durations[2]), 1e-4);
    }
}

} // namespace graze::drifting_test
