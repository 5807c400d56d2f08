// Switches with a continuous vector field, such as a soft stop: branches of a driven oscillator whose touches have a
// closed form.

#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace graze::smooth_switch_test {

using namespace graze::testing;
using std::numbers::pi;

/// x'' + 2 z x' + x + k max(x - g, 0) = F cos(w t).
struct SoftStop {
    double F, w, z, k, g;

    double size(double at) const { return std::hypot(1 - at * at, 2 * z * at); }
    Model model(const char* kind) const {
        return TwoModes{
            .parameters = fmt::format("F = {:.17g}\nw = {:.17g}\nz = {:.17g}\nk = {:.17g}\ng = {:.17g}", F, w, z, k, g),
            .states = "x = 0\nv = 0",
            .clock = "w",
            .first = {"free", "x = 'v', v = 'F*cos(theta) - 2*z*v - x'", "on", "g - x"},
            .second = {"contact", "x = 'v', v = 'F*cos(theta) - 2*z*v - x - k*(x - g)'", "off", "x - g"},
            .kind = kind}
            .model();
    }
    /// The free motion.
    Orbit orbit(const Model& made) const {
        const std::complex<double> i(0, 1), amplitude = F / (1 - w * w + 2.0 * i * z * w);
        return given_orbit(made, "free:start", {{amplitude.real(), (i * w * amplitude).real(), 0}}, {2 * pi / w});
    }
};

TEST(SmoothSwitch, TouchIsWhereTheFreeMotionReachesTheStop) {
    for (const SoftStop& stop :
         {SoftStop{1.55, 1.8, 0.02, 100, 1}, SoftStop{0.2, 0.7, 0.1, 5, 1}, SoftStop{0.1, 2.3, 0.3, 0.5, 1e-3}})
        for (const char* const kind : {"section", "barrier"}) {
            const Model model = stop.model(kind);
            const double least = stop.g * stop.size(stop.w), inside = std::min(stop.F, 0.5 * least);
            SoftStop free = stop;
            free.F = inside;
            const Model weak = free.model(kind);
            const Branch branch =
                follow_branch(System(weak), free.orbit(weak), in_parameter(weak, "F", 0.1 * inside, 10 * least));
            ASSERT_EQ(names(branch), "GR") << kind << ' ' << stop.w << ' ' << branch.detail;
            EXPECT_NEAR(branch.special[0].parameter, least, 1e-11 * least) << kind;
            EXPECT_EQ(branch.outcome, BranchOutcome::unphysical);
        }
}

TEST(SmoothSwitch, TouchesExistOnBothSidesOfTheResonance) {
    const double F = 1.8171679737395643, z = 0.02, g = 1;
    // (1 - w^2)^2 + 4 z^2 w^2 = (F/g)^2
    const double middle = 1 - 2 * z * z, root = std::sqrt(middle * middle - 1 + F * F / (g * g));
    const double above = std::sqrt(middle + root);
    const SoftStop stop{F, 2.403, z, 0.5, g};
    const Model model = stop.model("section");
    const BranchSettings settings = in_parameter(model, "w", 0.1, 5, -1);
    const Branch branch = follow_branch(System(model), stop.orbit(model), settings);
    ASSERT_EQ(names(branch), "GR") << branch.detail;
    EXPECT_NEAR(branch.special[0].parameter, above, 1e-11);
}

TEST(SmoothSwitch, PeriodFixedByTheForceHasNoExtremum) {
    // The contact speed vanishes at the end of the branch, where the frequency still varies.
    const SoftStop stop{1, 1.472, 0.03, 20, 0.2};
    const Model model = stop.model("section");
    const Branch branch =
        follow_branch(System(model), settled(model, "start", 400).orbit, in_parameter(model, "w", 0.2, 4));
    EXPECT_TRUE(of_type(branch, PointType::extremum).empty()) << names(branch);
    ASSERT_FALSE(of_type(branch, PointType::grazing).empty()) << names(branch);
}

TEST(SmoothSwitch, CurvesOfTouchesMayBeginAtAVanishingContact) {
    const SoftStop stop{0.5, 0.8, 0.1, 5, 1};
    const Model model = stop.model("section");
    const BranchSettings settings = in_parameter(model, "F", 0.1, 2, -1);
    const Branch branch = follow_branch(System(model), settled(model, "start").orbit, settings);
    const auto touches = of_type(branch, PointType::grazing);
    ASSERT_EQ(touches.size(), 1U) << names(branch);
    ASSERT_TRUE(touches[0].at_end);
    EXPECT_NEAR(touches[0].parameter, stop.g * stop.size(stop.w), 1e-9);
    for (const int way : {1, -1}) {
        const Branch curve = curve_of(model, touches[0], in_parameter(model, "w", 0.3, 3), "F", 0.01, 20, way);
        EXPECT_EQ(curve.outcome, BranchOutcome::bound) << curve.detail;
        EXPECT_GT(curve.points.size(), 3U);
        for (const BranchPoint& one : curve.points)
            EXPECT_NEAR(one.solution.orbit.parameters[0], stop.g * stop.size(one.parameter), 1e-11);
    }
}

TEST(SmoothSwitch, SecondContactAppearsAndDisappears) {
    const SoftStop stop{1, 0.641, 0.03, 2, 1};
    const Model model = stop.model("section");
    const BranchSettings settings = in_parameter(model, "w", 0.2, 4, -1);
    const Branch once = follow_branch(System(model), settled(model, "start").orbit, settings);
    ASSERT_EQ(names(once), "GR") << once.detail;
    const Branch more = follow(model, branches_at(System(model), once.special[0], settings).front(), settings);
    ASSERT_EQ(names(more), "GR") << more.detail;
    // The vanishing contact lies across the start of the orbit.
    EXPECT_TRUE(more.special[0].at_end);
    const Branch fewer = follow(model, branches_at(System(model), more.special[0], settings).front(), settings);
    EXPECT_EQ(names(fewer), "BD") << fewer.detail;
    EXPECT_EQ(fewer.points.back().solution.orbit.segments(), 2U);
    // Where the touch meets the remaining contact no multiplier is -1, since the vector field is continuous.
    for (const int way : {1, -1}) {
        const Branch curve = curve_of(model, once.special[0], in_parameter(model, "w", 0.2, 4), "F", 0.05, 4, way);
        EXPECT_GT(curve.points.size(), 10U) << curve.detail;
        EXPECT_TRUE(of_type(curve, PointType::flip).empty()) << names(curve);
    }
}

} // namespace graze::smooth_switch_test
