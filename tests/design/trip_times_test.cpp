// Trip times: of the MEMS switch as published, of the beam's fold by its exponent.

#include "graze/design/trip_times.hpp"

#include "base/message_of.hpp"
#include "switches.hpp"

#include <gmock/gmock.h>

namespace graze::testing::trip_times_test {

TEST(TripTimes, OfTheMemsSwitchAreThePublishedOnes) {
    Design design = load_design("mems-switch");
    design.trip.overshoots = {1e-4, 1e-20};
    const TripPoint trip = trip_of(design);
    const TripTimes times = trip_times(trip, trip.point.solution.orbit, class_at(trip), design.trip);
    ASSERT_EQ(times.rows.size(), 2U);
    ASSERT_TRUE(times.rows[0].simulated && times.rows[0].best());
    EXPECT_NEAR(times.rows[0].best()->time, 27.31773570163, 1e-8 * 27);
    EXPECT_FALSE(times.rows[1].simulated); // below the resolution of the voltage
    ASSERT_TRUE(times.rows[1].best());
    EXPECT_GT(times.rows[1].best()->time, times.rows[0].best()->time);
}

TEST(TripTimes, BeyondAFoldScaleWithTheRootOfTheOvershoot) {
    const auto [design, trip] =
        with_trip(beam_design("[trip]\nuntil = 'penetration=0.009'\novershoots = [1e-6, 1e-8]\n"));
    const TripTimes times = trip_times(trip, trip.point.solution.orbit, class_at(trip), design.trip);
    ASSERT_EQ(times.rows.size(), 2U);
    ASSERT_TRUE(times.rows[0].best() && times.rows[1].best());
    // Half of the passage, pi / 2 root(a overshoot), remains from the fold itself, plus some cycles beyond it: without
    // these the ratio would be ten.
    EXPECT_NEAR(times.rows[1].best()->time / times.rows[0].best()->time, 10, 1);
}

TEST(TripTimes, AreAbsentIfTheMotionPersists) {
    const auto [design, trip] = with_trip(oscillator_design());
    TripClass found = class_at(trip);
    found.outcome = GrazingOutcome::persists;
    const TripTimes times = trip_times(trip, trip.point.solution.orbit, found, design.trip);
    EXPECT_TRUE(times.rows.empty());
    EXPECT_FALSE(times.reason.empty());
}

TEST(TripTimes, HaveDefaultOvershootsRelativeToTheTripValue) {
    EXPECT_EQ(overshoots_of({}, 4e6, 1).front(), 1e4);
    EXPECT_EQ(overshoots_of({}, 4e-9, -1).front(), -1e-11);
    EXPECT_EQ(overshoots_of({}, 4e6, 1).size(), 10U);
}

TEST(TripTimes, RefuseOvershootsFarBeyondTheTripValue) {
    TripRequest request;
    request.overshoots = {2e-6, 2e-300};
    EXPECT_EQ(overshoots_of(request, -4e-9, -1), (std::vector<double>{-2e-6, -2e-300}));
    request.overshoots.push_back(5e-6);
    request.place = {"d.toml", 7, 14};
    EXPECT_THAT(message_of([&] { overshoots_of(request, -4e-9, -1); }),
                ::testing::StartsWith("d.toml:7:14: the overshoot 5e-06 is 1.25e+03 times the trip"));
}

} // namespace graze::testing::trip_times_test
