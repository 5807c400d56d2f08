// Return maps of grazing orbits against closed forms and published values.

#include "graze/base/input_error.hpp"
#include "graze/grazing/cycle_map.hpp"
#include "graze/grazing/map_motion.hpp"
#include "graze/grazing/trial.hpp"
#include "orbit/orbits.hpp"
#include "trajectory/simulate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::cycle_map_test {

using namespace graze::testing;

using std::numbers::pi;

/// The ball at rest in front of the shaker; with a = b the shaker just touches it.
Orbit resting_ball(const Model& model) {
    const double f = model.parameter_values()[model.independent_parameter("f").place()];
    return given_orbit(model, "free:phase0", {{0, 0, 0}}, {1 / f});
}

struct Shaker {
    double f, n, log_c;
};
constexpr Shaker published[] = {{6, 1, 1.01155084345},
                                {10, 2, 1.23874262010},
                                {14, 2, 1.23958271687},
                                {18, 3, 1.48867209817},
                                {22, 3, 1.34410718122}};

TEST(CycleMap, BallAndShakerHasThePublishedGrowth) {
    constexpr double zeta = 0.0881, omega_n = 25.2, e = 0.55, b = 0.65;
    for (const Shaker& one : published) {
        const Model model = shipped_with("ball-and-shaker", {{"a", b}, {"f", one.f}});
        const System system(model);
        const Orbit orbit = resting_ball(model);
        const std::vector<OrbitTouch> touches = touches_of(system, orbit);
        ASSERT_EQ(touches.size(), 1U);
        EXPECT_NEAR(touches[0].time, 0.25 / one.f, 1e-8 / one.f);
        CycleMapOptions options;
        options.parameter = model.independent_parameter("a");
        const CycleMap map = cycle_map(system, orbit, touches[0], options);
        ASSERT_TRUE(map.exists()) << map.reason;
        EXPECT_EQ(map.contact.order, MapOrder::square_root);
        const double omega = 2 * pi * one.f, own = omega_n * std::sqrt(1 - zeta * zeta);
        // The tolerances allow for sums of a few terms of the size of the result.
        EXPECT_NEAR(map.contact.acceleration, b * omega * omega, 1e-13 * b * omega * omega);
        EXPECT_NEAR(map.contact.restitution, e, 1e-14);
        ASSERT_TRUE(map.clearance_rate);
        EXPECT_NEAR(*map.clearance_rate, -1, 1e-13);
        const std::vector<double> projections = map.projections(12);
        std::size_t next = 0;
        for (std::size_t k = 1; k <= projections.size(); ++k) {
            const double time = static_cast<double>(k) / one.f;
            // The flow has a relative tolerance of 1e-13 and takes a few steps per cycle.
            EXPECT_NEAR(projections[k - 1], (1 + e) * std::exp(-zeta * omega_n * time) * std::sin(own * time) / own,
                        1e-12 * (1 + e) / own)
                << k;
            if (next == 0 && projections[k - 1] < 0)
                next = k;
        }
        EXPECT_EQ(static_cast<double>(next), one.n);
        // The jump of the velocity is 1 + e times the speed: c of Eq. (4.25).
        const double c = std::sqrt(-2 * map.contact.acceleration * projections[next - 1] * (1 + e));
        EXPECT_NEAR(std::log10(c), one.log_c, 1e-11); // all published digits
        const double closed = omega * (1 + e) *
                              std::sqrt(-2 * b * std::exp(-2 * one.n * pi * zeta * omega_n / omega) / own *
                                        std::sin(2 * one.n * pi * own / omega));
        EXPECT_NEAR(c, closed, 1e-12 * closed);
    }
}

/// Returns the steady motion that just touches both stops. @param half return a half orbit
Orbit between_stops(Model& model, bool half) {
    const double zeta = 0.02, omega = 1.2;
    const double in_phase = (1 - omega * omega), out_of_phase = 2 * zeta * omega,
                 square = in_phase * in_phase + out_of_phase * out_of_phase;
    model.set_parameter("sigma", 1 / std::sqrt(square));
    Orbit orbit = given_orbit(model, "free:phase0", {{in_phase / square, omega * out_of_phase / square, 0}},
                              {(half ? 1 : 2) * pi / omega});
    if (half)
        orbit.symmetry = 0;
    return orbit;
}

TEST(CycleMap, HalfOrbitEndsAtItsImage) {
    Model model = load_model("impact-oscillator-two-stops");
    const Orbit half = between_stops(model, true);
    const System system(model);
    CycleMapOptions options;
    options.parameter = model.independent_parameter("amplitude");
    const auto touches = touches_of(system, half, options);
    ASSERT_EQ(touches.size(), 1U);
    const CycleMap map = cycle_map(system, half, touches[0], options);
    ASSERT_TRUE(map.exists()) << map.reason;
    EXPECT_TRUE(map.half);
    // After half a period the symmetry reverses the sign of the change by the impact.
    const double zeta = 0.02, d = std::sqrt(1 - zeta * zeta), time = pi / 1.2;
    const auto projections = map.projections(6);
    for (int k = 1; k <= 6; ++k) {
        const double closed = (k % 2 == 0 ? 1 : -1) * 1.7 * std::exp(-zeta * k * time) * std::sin(d * k * time) / d;
        EXPECT_NEAR(projections[static_cast<std::size_t>(k - 1)], closed, 1e-11) << k;
    }
    EXPECT_NE(verdict_of(map).outcome, GrazingOutcome::undecided) << verdict_of(map).reason;
    const Verdict verdict = verdict_of(map);
    const Trial trial = try_verdict(system, map, verdict, *options.parameter);
    EXPECT_EQ(trial.outcome, TrialOutcome::agreed) << trial.reason;
}

TEST(CycleMap, OrbitWithTwoTouchesIsUndecided) {
    Model model = load_model("impact-oscillator-two-stops");
    const Orbit whole = between_stops(model, false);
    const System system(model);
    const auto touches = touches_of(system, whole);
    ASSERT_EQ(touches.size(), 2U);
    const CycleMap map = cycle_map(system, whole, touches[0]);
    EXPECT_TRUE(map.exists());
    EXPECT_EQ(map.touches, 2U);
    const Verdict verdict = verdict_of(map);
    EXPECT_EQ(verdict.outcome, GrazingOutcome::undecided);
    EXPECT_EQ(verdict.reason, "the orbit touches in 2 places at once");
}

TEST(CycleMap, ReasonTellsWhyTheMapDoesNotExist) {
    const Model model = shipped_with("ball-and-shaker", {{"a", 0.6}});
    const System system(model);
    const Orbit orbit = resting_ball(model);
    EXPECT_TRUE(touches_of(system, orbit).empty());
    OrbitTouch touch;
    touch.event = *model.find_event("contact");
    touch.time = 0.25 / 6;
    const CycleMap map = cycle_map(system, orbit, touch);
    EXPECT_FALSE(map.exists());
    EXPECT_EQ(map.reason, "the state is not on the surface of event 'contact'");
    EXPECT_TRUE(map.projections(3).empty());
    EXPECT_EQ(verdict_of(map).reason, map.reason);
    touch.time = 0.75 / 6; // time at which the shaker is farthest away
    EXPECT_EQ(cycle_map(system, orbit, touch).reason,
              "the function of event 'contact' has a maximum, not a minimum, at the touch");
    EXPECT_THROW(map_motion(map, -1e-6), InputError);
}

TEST(CycleMap, ArgumentsThatDoNotFitAreRefused) {
    Model model = load_model("ball-and-shaker");
    const System system(model);
    const Orbit orbit = resting_ball(model);
    OrbitTouch touch;
    touch.segment = 3;
    EXPECT_THROW(cycle_map(system, orbit, touch), InputError);
    touch.segment = 0;
    touch.event = 9;
    EXPECT_THROW(cycle_map(system, orbit, touch), InputError);
    touch.event = 0;
    touch.time = NAN;
    EXPECT_THROW(cycle_map(system, orbit, touch), InputError);
    CycleMapOptions options;
    options.tolerance = 2;
    touch.time = 0.01;
    EXPECT_THROW(cycle_map(system, orbit, touch, options), InputError);
    TrialOptions trial;
    trial.cycles = 0;
    EXPECT_THROW(trial.validate(), InputError);
    MapMotionOptions motion;
    motion.recurrence = -1;
    EXPECT_THROW(motion.validate(), InputError);
    EXPECT_THROW(CycleMap{}.projections(10'000'001), InputError);
}

} // namespace graze::cycle_map_test
