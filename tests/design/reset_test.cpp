// The reset value of the testbed: the published fold of its period-3 orbit.

#include "graze/design/reset.hpp"

#include "switches.hpp"

namespace graze::testing::reset_test {

TEST(Reset, OfTheTestbedIsTheFoldOfItsPeriod3Orbit) {
    const TripPoint trip = trip_of(parse_design(R"(name = "bed"
control = "V0"
[approach]
study = "electromagnetic-testbed"
run = "no_impact_6_25Hz"
point = "GR1"
[dimensions.delta]
range = [0.0005, 0.002]
)",
                                                "d.toml"));
    EXPECT_NEAR(trip.value(), 4.833263260865, 1e-8);
    ResetOptions options;
    options.overshoot = 0.001; // below 4.846, where the period-3 orbit loses its symmetry
    options.least = 4;
    const Reset reset = reset_of(trip, trip.point.solution.orbit, options);
    ASSERT_TRUE(reset.value) << reset.reason;
    EXPECT_EQ(reset.how, "fold");
    EXPECT_NEAR(*reset.value, 4.789014895054, 1e-8 * 4.8);
    EXPECT_NEAR(*reset.hysteresis(trip.value()), 4.833263260865 - 4.789014895054, 1e-7);
    EXPECT_TRUE(reset.point);
    // If it is not followed that far, the orbit is still there.
    options.least = 4.8;
    const Reset remains = reset_of(trip, trip.point.solution.orbit, options);
    EXPECT_FALSE(remains.value);
    EXPECT_FALSE(remains.reason.empty());
}

} // namespace graze::testing::reset_test
