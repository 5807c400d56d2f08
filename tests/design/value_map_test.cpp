// Trip values over one and two dimensions, and the tuning curve, against closed forms.

#include "graze/design/value_map.hpp"

#include "graze/base/input_error.hpp"
#include "switches.hpp"

namespace graze::testing::value_map_test {

TEST(ValueMap, OfAnOscillatorEqualsTheClosedForm) {
    const auto [design, trip] = with_trip(oscillator_design());
    MapSettings settings;
    settings.points = 7;
    const std::vector<MappedValue> curve = value_curve(trip, design.dimensions[1], settings);
    ASSERT_EQ(curve.size(), 7U);
    EXPECT_EQ(curve.front().x, 0.05);
    EXPECT_EQ(curve.back().x, 0.3);
    for (const MappedValue& one : curve) {
        ASSERT_TRUE(one.found) << one.problem;
        EXPECT_TRUE(one.admissible);
        EXPECT_NEAR(one.value, oscillator_value(0.2, one.x), 1e-12);
    }
    settings.points = 17; // more than one tile
    const std::vector<MappedValue> plane = value_plane(trip, design.dimensions[0], design.dimensions[1], settings);
    ASSERT_EQ(plane.size(), 17U * 17U);
    for (const MappedValue& one : plane) {
        ASSERT_TRUE(one.found) << one.problem;
        EXPECT_NEAR(one.value, oscillator_value(one.x, one.y), 1e-12);
    }
    // With threads the results are the same bit for bit.
    settings.jobs = 3;
    const std::vector<MappedValue> again = value_plane(trip, design.dimensions[0], design.dimensions[1], settings);
    for (std::size_t i = 0; i < plane.size(); ++i)
        EXPECT_EQ(again[i].value, plane[i].value);
}

/// The class of a device is the same from the solution's own map and from a map computed anew. The plane extends to
/// frequencies below 0.976, where the touch is in another segment of the orbit.
TEST(ValueMap, ClassesOfAPlaneEqualThoseOfMapsComputedAnew) {
    const auto [design, trip] = with_trip(load_design("mems-switch"));
    const DesignDimension& delta = design.dimensions[*design.find_dimension("delta")];
    DesignDimension omega = design.dimensions[*design.find_dimension("omega")];
    omega.least = 0.97;
    MapSettings settings;
    settings.points = 5;
    LocatedValue located(trip.system, trip.point, trip.control, {delta.parameter, omega.parameter});
    std::size_t compared = 0;
    for (const MappedValue& one : value_plane(trip, delta, omega, settings)) {
        if (!one.found || !one.admissible)
            continue;
        const double values[] = {one.x, one.y};
        const LocatedSolution solution = located(values);
        ASSERT_TRUE(solution.found) << solution.problem;
        EXPECT_FALSE(solution.map); // it was not requested
        EXPECT_EQ(class_at(moved_to(trip, solution.orbit)).outcome, one.outcome) << one.x << ", " << one.y;
        ++compared;
    }
    EXPECT_GE(compared, 15U);
}

TEST(ValueMap, ClassesEqualThoseOfEachDevicesOwnMap) {
    // The class of a damped oscillator depends on its own cycle: it must agree point by point.
    const auto [design, trip] = with_trip(oscillator_design());
    MapSettings settings;
    settings.points = 5;
    for (const MappedValue& one : value_curve(trip, design.dimensions[1], settings)) {
        Design other = design;
        other.set.emplace_back("zeta", one.x);
        other.set.erase(other.set.begin()); // zeta
        EXPECT_EQ(class_at(trip_of(other)).outcome, one.outcome) << one.x;
    }
}

TEST(Tuning, IsTheInverseOfTheValueCurve) {
    const auto [design, trip] = with_trip(oscillator_design());
    MapSettings settings;
    settings.points = 9;
    const Tuning tuning = tuning_curve(trip, design.dimensions[0], settings);
    EXPECT_NEAR(tuning.least, oscillator_value(0.1, 0.1), 1e-12);
    EXPECT_NEAR(tuning.greatest, oscillator_value(0.4, 0.1), 1e-12);
    for (const TuningPoint& one : tuning.points) {
        ASSERT_TRUE(one.found) << one.problem;
        EXPECT_NEAR(oscillator_value(one.position, 0.1), one.value, 1e-12);
    }
    DesignDimension idle = design.dimensions[0];
    idle.name = "e"; // restitution: there are no contacts
    idle.parameter = trip.system.model().independent_parameter("e");
    idle.least = 0.1;
    idle.greatest = 0.9;
    EXPECT_THROW(tuning_curve(trip, idle, settings), InputError);
}

} // namespace graze::testing::value_map_test
