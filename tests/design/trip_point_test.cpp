// Trip points by the design's own branch, and by a study's.

#include "graze/design/trip_point.hpp"

#include "base/message_of.hpp"
#include "switches.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace graze::testing::trip_point_test {

using ::testing::HasSubstr;

TEST(TripPoint, OfAnOscillatorEqualsTheClosedForm) {
    const TripPoint trip = trip_of(oscillator_design());
    EXPECT_TRUE(trip.is_touch());
    // Newton's method ends with a correction below 1e-10, whose square is below round-off.
    EXPECT_NEAR(trip.value(), oscillator_value(0.2, 0.1), 1e-13);
    EXPECT_TRUE(trip.earlier.empty());
}

TEST(TripPoint, OfTheMemsSwitchIsThePublishedVoltage) {
    const TripPoint trip = trip_of(load_design("mems-switch"));
    EXPECT_NEAR(trip.value(), 0.2013662121541341, 1e-12);
    const TripClass found = class_at(trip);
    EXPECT_EQ(found.outcome, GrazingOutcome::lost);
    EXPECT_EQ(class_name(found.outcome), "trips");
}

TEST(TripPoint, OfTheDeviceEqualsThatOfTheScaledModelInVolts) {
    Design design = load_design("mems-switch-device");
    const auto value = [&](const char* name) {
        return design.model.parameter_values()[*design.model.find_parameter(name)];
    };
    const double gap = value("d");
    design.set = {{"zeta", 0.02}, {"stop", 0.6 * gap}};
    const TripPoint trip = trip_of(design);
    // Eq. (6.3), by hand: m w0^2 d^3 / (epsilon A / 2), with m in 1e-9 kg, w0 in 1e3/s, d in 1e-6 m, A in 1e-12 m^2.
    const double w0 = 2e3 * std::numbers::pi * value("f0");
    const double unit = std::sqrt(2 * value("m") * 1e-9 * w0 * w0 * std::pow(1e-6 * gap, 3) /
                                  (8.8541878128e-12 * value("area") * 1e-12));
    EXPECT_NEAR(trip.value(), 0.2013662121541341 * unit, 1e-12 * unit);
    EXPECT_EQ(class_at(trip).outcome, GrazingOutcome::lost);
}

TEST(TripPoint, OfAStudyMayBeAFoldAfterATouch) {
    const TripPoint trip = trip_of(beam_design());
    EXPECT_EQ(trip.point.type, PointType::fold);
    EXPECT_NEAR(trip.value(), 0.032825650930776, 1e-8 * 0.0328); // published to at least eight digits
    ASSERT_FALSE(trip.earlier.empty());
    EXPECT_EQ(trip.earlier.front().label, "GR1");
    EXPECT_NEAR(trip.earlier.front().value, 0.030040810557599, 1e-8 * 0.03);
    EXPECT_EQ(class_at(trip).outcome, GrazingOutcome::folds);
}

TEST(TripPoint, OfANeighbourHasItsTouchInItsOwnSegment) {
    const TripPoint trip = trip_of(load_design("mems-switch"));
    const ParameterId omega = trip.system.model().independent_parameter("omega");
    LocatedValue located(trip.system, trip.point, trip.control, {omega});
    // Below some 0.976 the electrode touches before the voltage is switched on.
    const double slow[] = {0.97};
    const LocatedSolution solution = located(slow);
    ASSERT_TRUE(solution.found) << solution.problem;
    const TripPoint moved = moved_to(trip, solution.orbit);
    EXPECT_NE(moved.point.segment, trip.point.segment);
    // The moved point is a valid touch: solving again does not change it.
    const LocatedValue again(moved.system, moved.point, moved.control, {omega});
    EXPECT_NEAR(again.value(), solution.value, 1e-11);
}

TEST(TripPoint, IsRefusedIfTheBranchEndsBefore) {
    Design design = load_design("mems-switch");
    design.approach.greatest = 0.1;
    EXPECT_THAT(message_of([&] { trip_of(design); }),
                HasSubstr("without a touch of 'stop'; points before: BD1 at 0.1"));
}

} // namespace graze::testing::trip_point_test
