// Branches of models with dry friction and of typical user models, with closed forms.

#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::user_models_test {

using namespace graze::testing;
using std::numbers::pi;

/// Sliding without sticking under dry friction F and the force cos(omega t) (J. P. Den Hartog, 1931), without viscous
/// damping: amplitude sqrt(V^2 - (F U)^2), V the response and U the damping function, force at the turning points
/// omega^2 times that.
struct Sliding {
    double omega, friction;
    double response() const { return 1 / (1 - omega * omega); }
    double damping() const { return std::sin(pi / omega) / (omega * (1 + std::cos(pi / omega))); }
    double amplitude() const { return std::sqrt(response() * response() - std::pow(friction * damping(), 2)); }
    double force() const { return omega * omega * amplitude(); }
};

Model sliding_model(const Sliding& known, double greatest_at_rest) {
    return shipped_with("dry-friction-oscillator", {{"zeta", 0},
                                                    {"omega", known.omega},
                                                    {"friction_dynamic", known.friction},
                                                    {"friction_static", greatest_at_rest}});
}

Orbit sliding_orbit(const Sliding& known, const Model& model) {
    // To the left, from a turning point on the right.
    const double x = known.amplitude(),
                 phase = std::atan2(-known.friction * known.damping() / known.response(), x / known.response());
    const Orbit orbit = given_orbit(model, "mass-backward:stops mass-forward:stops",
                                    {{x, 0, phase}, {-x, 0, phase + pi}}, {pi / known.omega, pi / known.omega});
    return half_orbit(System(model), orbit).value();
}

TEST(UserModels, DryFrictionSticksWhereDenHartogPredicts) {
    const Sliding known{0.8, 0.3};
    const Model model = sliding_model(known, 0.3);
    const BranchSettings settings = in_parameter(model, "friction_static", {}, 3);
    const Branch branch = follow_branch(System(model), sliding_orbit(known, model), settings);
    ASSERT_EQ(names(branch), "GU BD");
    EXPECT_NEAR(branch.special[0].parameter, known.force(), 1e-12);
    for (const BranchPoint& point : branch.points) {
        EXPECT_TRUE(point.solution.orbit.symmetry);
        EXPECT_TRUE(point.solution.certificate.admissible) << point.solution.certificate.reason;
        if (point.parameter < known.force()) {
            EXPECT_EQ(point.solution.orbit.segments(), 1U);
            EXPECT_NEAR(std::abs(point.solution.orbit.starts[0][0]), known.amplitude(), 1e-12);
        } else { // now the mass sticks, the longer the higher the static friction
            EXPECT_EQ(point.solution.orbit.segments(), 2U) << point.parameter;
        }
    }
    EXPECT_EQ(branch.points.back().solution.orbit.segments(), 2U);
}

TEST(UserModels, DryFrictionSlidesWithTheAmplitudeOfDenHartog) {
    // With more dynamic friction, and with another frequency.
    for (const char* parameter : {"friction_dynamic", "omega"}) {
        const Sliding begin{0.8, 0.3};
        const Model model = sliding_model(begin, 0.3);
        const BranchSettings settings = in_parameter(model, parameter, parameter[0] == 'o' ? 0.55 : 0.01, {}, -1);
        const Branch branch = follow_branch(System(model), sliding_orbit(begin, model), settings);
        ASSERT_GT(branch.points.size(), 3U);
        for (const BranchPoint& point : branch.points) {
            const Sliding known{parameter[0] == 'o' ? point.parameter : 0.8,
                                parameter[0] == 'o' ? 0.3 : point.parameter};
            if (point.solution.certificate.admissible) {
                EXPECT_NEAR(std::abs(point.solution.orbit.starts[0][0]), known.amplitude(), 1e-11);
            }
        }
        EXPECT_TRUE(of_type(branch, PointType::fold).empty());
    }
}

/// A spring that is stiffer on one side: x'' + 2 zeta x' + (1 or stiffness) x = load + cos(omega t).
Model bilinear(double stiffness) {
    return TwoModes{.parameters = fmt::format("stiffness = {:.17g}\nomega = 2.3\nzeta = 0.05\nload = 0", stiffness),
                    .states = "x = 0.5\nv = 0",
                    .clock = "omega",
                    .first = {"stiff", "x = 'v', v = 'load + cos(theta) - 2*zeta*v - stiffness*x'", "fall", "x"},
                    .second = {"soft", "x = 'v', v = 'load + cos(theta) - 2*zeta*v - x'", "rise", "-x"},
                    .kind = "barrier"}
        .model();
}

TEST(UserModels, BilinearOscillatorIsLinearForEqualSprings) {
    const Model model = bilinear(1.4);
    const Orbit orbit = settled(model, "start").orbit;
    const BranchSettings settings = in_parameter(model, "stiffness", 1, {}, -1);
    const Branch branch = follow_branch(System(model), orbit, settings);
    ASSERT_EQ(branch.outcome, BranchOutcome::bound) << names(branch);
    for (const BranchPoint& point : branch.points) {
        ASSERT_EQ(point.solution.multipliers.size(), 2U);
        // Without jumps of velocity, damping alone determines the product.
        EXPECT_NEAR((point.solution.multipliers[0] * point.solution.multipliers[1]).real(),
                    std::exp(-2 * 0.05 * point.solution.orbit.period()), 1e-11);
    }
    const Orbit& linear = branch.points.back().solution.orbit;
    const double amplitude = 1 / std::hypot(1 - 2.3 * 2.3, 0.23);
    EXPECT_NEAR(linear.period(), 2 * pi / 2.3, 1e-12);
    for (std::size_t k = 0; k < linear.segments(); ++k)
        EXPECT_NEAR(std::abs(linear.starts[k][1]), 2.3 * amplitude, 1e-11); // x = 0 is passed at the greatest speed
}

TEST(UserModels, BilinearOscillatorLeavesTheStiffSideAtATouch) {
    // With a load, x is load / stiffness + response and reaches zero where both are equal.
    Model model = bilinear(3);
    model.set_parameter("load", 10);
    model.set_initial("x", 3.3);
    const Orbit orbit = settled(model, "start").orbit;
    ASSERT_EQ(orbit.segments(), 1U);
    const BranchSettings settings = in_parameter(model, "load", -10, {}, -1);
    const Branch branch = follow_branch(System(model), orbit, settings);
    ASSERT_EQ(names(branch), "GR");
    EXPECT_NEAR(branch.special[0].parameter, 3 / std::hypot(3 - 2.3 * 2.3, 0.23), 1e-12);
    expect_touch(model, branch.special[0], 1);
    // Beyond, both springs act in turn, until the load presses the mass to the other side, where the soft spring acts
    // alone.
    const auto starts = branches_at(System(model), branch.special[0], settings);
    ASSERT_EQ(starts.size(), 1U);
    EXPECT_EQ(starts[0].orbit.segments(), 2U);
    const Branch both = follow(model, starts[0], settings);
    const auto lost = of_type(both, PointType::grazing);
    ASSERT_EQ(lost.size(), 1U) << names(both);
    EXPECT_NEAR(lost[0].parameter, -1 / std::hypot(1 - 2.3 * 2.3, 0.23), 1e-11);
    const auto on = branches_at(System(model), lost[0], settings);
    ASSERT_EQ(on.size(), 1U);
    EXPECT_EQ(on[0].orbit.segments(), 1U);
    const Branch soft = follow(model, on[0], settings);
    ASSERT_FALSE(soft.points.empty());
    EXPECT_EQ(names(soft), "BD");
    EXPECT_EQ(soft.points.back().parameter, -10);
}

} // namespace graze::user_models_test
