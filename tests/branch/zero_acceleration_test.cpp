// A curve of contacts of zero speed that ends where their acceleration vanishes too: a closed form.

#include "maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace graze::zero_acceleration_test {

using namespace graze::testing;

/// A ball is released from rest at a height, falls onto a table that moves as A sin(omega t), rests on it, and is
/// lifted again after each period. With the phase p of the table at which it lands with zero speed,
///     A = -p / cos(p) g / omega^2,   H = (p^2 / 2 - p tan(p)) g / omega^2 - k w(p),
/// where the state w depends on the duration of the fall, so that orbits depend on the landing. The gap has the
/// acceleration A omega^2 sin(p) - g, which is zero where p tan(p) = -1. Its next derivative is negative there: the gap
/// is positive before.
struct SoftLanding {
    double length, time; ///< units
    double g = length / (time * time), omega = 1.3 / time, unit = g / (omega * omega);
    Model model =
        TwoModes{
            .parameters = fmt::format("A = {}\nH = {}\ng = {}\nomega = {}\nk = {}", amplitude(first), height(first), g,
                                      omega, 0.3 * unit),
            .states = "x = 1\nv = 0\nw = 1\nclock = 0",
            .first = {"falling", "x = 'v', v = '-g', w = '-0.1*omega*w', clock = 1", "contact",
                      "x - A*sin(omega*clock)", "v = 'A*omega*cos(omega*clock)'"},
            .second =
                {"resting",
                 "x = 'A*omega*cos(omega*clock)', v = '-A*omega^2*sin(omega*clock)', w = '-0.3*omega*w', clock = 1",
                 "taken", "2*pi/omega - clock", "x = 'H + k*w'\nv = 0\nw = 'w + 1'\nclock = 0"},
            .kind = "barrier"}
            .model();

    static constexpr double first = 2.2; // phase of the touch at the start of curves

    double amplitude(double phase) const { return -phase / std::cos(phase) * unit; }
    double height(double phase) const {
        return (phase * phase / 2 - phase * std::tan(phase) - 0.3 * memory(phase)) * unit;
    }
    /// Returns w before its increase by 1 at the release; it decays at different rates during fall and rest.
    static double memory(double phase) { return 1 / (std::exp(0.6 * std::numbers::pi - 0.2 * phase) - 1); }
    /// p tan(p) = -1, as p sin(p) + cos(p) = 0 by Newton's method
    static double last_phase() {
        double p = 2.8;
        for (int i = 0; i < 6; ++i)
            p -= (p * std::sin(p) + std::cos(p)) / (p * std::cos(p));
        return p;
    }

    /// Follows orbits of this amplitude in the height, up to a touch.
    SpecialPoint touch(double height_then, int direction) {
        model.set_parameter("H", height_then);
        const double a = amplitude(first);
        double phase = 0; // phase of landing: the first zero of the gap
        const auto gap = [&](double p) { return height_then + (0.3 * memory(p) - p * p / 2) * unit - a * std::sin(p); };
        while (gap(phase) > 0)
            phase += 1e-3;
        const double t = phase / omega, w = 1 + memory(phase);
        const Orbit orbit =
            given_orbit(model, "contact taken",
                        {{height_then + 0.3 * unit * (w - 1), 0, w, 0},
                         {a * std::sin(phase), a * omega * std::cos(phase), w * std::exp(-0.1 * phase), t}},
                        {t, 2 * std::numbers::pi / omega - t});
        BranchSettings settings = in_height();
        settings.direction = direction;
        settings.stop_at = {PointType::grazing};
        const Branch branch = follow_branch(System(model), orbit, settings);
        EXPECT_EQ(branch.outcome, BranchOutcome::stopped) << names(branch) << branch.detail;
        return branch.special.empty() ? SpecialPoint{} : branch.special.back();
    }
    BranchSettings in_height() const { return in_parameter(model, "H", 1 * unit, 7 * unit); }
    Branch curve(const SpecialPoint& from, int way, bool stops = true) const {
        BranchSettings settings = in_height();
        settings.stop_when_unphysical = stops;
        return curve_of(model, from, settings, "A", 2 * unit, 5 * unit, way);
    }
};

struct Units {
    double length, time;
};

class ZeroAcceleration : public ::testing::TestWithParam<Units> {
protected:
    SoftLanding one{.length = GetParam().length, .time = GetParam().time};

    double amplitude_at(const OrbitSolution& solution) const { return value_of(one.model, solution, "A"); }
    double height_at(const OrbitSolution& solution) const { return value_of(one.model, solution, "H"); }
    /// Verifies a point of a curve by the phase of landing at zero speed.
    void expect_on_curve(const BranchPoint& point) const {
        const double phase = point.solution.orbit.durations[0] * one.omega;
        // The phase is accurate to 1e-13.
        EXPECT_NEAR(amplitude_at(point.solution), one.amplitude(phase), 1e-11 * one.unit);
        EXPECT_NEAR(height_at(point.solution), one.height(phase), 1e-11 * one.unit);
        EXPECT_EQ(point.solution.certificate.admissible, phase <= SoftLanding::last_phase() + 1e-6) << phase;
    }
};

TEST_P(ZeroAcceleration, LandingAtZeroSpeedHasItsClosedForm) {
    const double last = SoftLanding::last_phase();
    const SpecialPoint touch = one.touch(0.97 * one.height(SoftLanding::first), 1);
    ASSERT_TRUE(touch.at_end);
    EXPECT_NEAR(touch.parameter, one.height(SoftLanding::first), 1e-11 * one.unit);
    // Towards lower heights the curve ends there.
    const Branch curve = one.curve(touch, -1);
    // A has an extremum there too, before or after it by round-off.
    ASSERT_TRUE(names(curve) == "ZA" || names(curve) == "EX ZA") << names(curve) << ' ' << curve.detail;
    EXPECT_EQ(curve.outcome, BranchOutcome::unphysical) << curve.detail;
    const SpecialPoint& point = curve.special.back();
    EXPECT_TRUE(point.located);
    EXPECT_TRUE(point.solution.certificate.admissible);
    EXPECT_EQ(point.detail, "contact: touched without acceleration");
    // The phase is as accurate as the parameters.
    EXPECT_NEAR(point.solution.orbit.durations[0] * one.omega, last, 1e-10);
    EXPECT_NEAR(amplitude_at(point.solution), one.amplitude(last), 1e-10 * one.unit);
    EXPECT_NEAR(height_at(point.solution), one.height(last), 1e-10 * one.unit);
    EXPECT_LE(point.bracket.first, point.parameter * (1 + 1e-12));
    EXPECT_GE(point.bracket.second, point.parameter * (1 - 1e-12));
    for (const BranchPoint& each : curve.points)
        expect_on_curve(each);
    // In the other direction the acceleration only grows.
    const Branch away = one.curve(touch, 1);
    EXPECT_EQ(names(away), "BD") << away.detail;
    for (const BranchPoint& each : away.points)
        expect_on_curve(each);
}

TEST_P(ZeroAcceleration, CurveBeyondItIsInadmissible) {
    const SpecialPoint touch = one.touch(0.97 * one.height(SoftLanding::first), 1);
    ASSERT_TRUE(touch.at_end);
    const Branch curve = one.curve(touch, -1, false);
    EXPECT_EQ(of_type(curve, PointType::zero_acceleration).size(), 1U) << names(curve);
    ASSERT_GT(curve.points.size(), 10U);
    for (const BranchPoint& each : curve.points)
        expect_on_curve(each);
    EXPECT_GT(curve.points.back().solution.orbit.durations[0] * one.omega, 3.5);
}

/// For balls that touch and land later, the touch reaches the end of its segment there.
TEST_P(ZeroAcceleration, CurveOfTouchesInsideASegmentEndsThere) {
    const SpecialPoint inside = one.touch(1.03 * one.height(SoftLanding::first), -1);
    ASSERT_EQ(inside.type, PointType::grazing);
    ASSERT_FALSE(inside.at_end);
    const Branch curve = one.curve(inside, -1);
    EXPECT_NE(curve.outcome, BranchOutcome::bound) << curve.detail;
    ASSERT_FALSE(curve.points.empty());
    // The landing follows the touch at three times the remaining phase, and both vanish: the curve ends within one step
    // of it.
    const double last = SoftLanding::last_phase();
    EXPECT_NEAR(amplitude_at(curve.points.back().solution), one.amplitude(last), 1e-2 * one.unit);
    EXPECT_NEAR(height_at(curve.points.back().solution), one.height(last), 1e-2 * one.unit);
}

INSTANTIATE_TEST_SUITE_P(units, ZeroAcceleration, ::testing::Values(Units{1, 1}, Units{2e-9, 3e-6}, Units{5e3, 4e4}),
                         [](const auto& of) {
                             return std::string(of.index == 0 ? "one" : of.index == 1 ? "nano" : "kilo");
                         });

} // namespace graze::zero_acceleration_test
