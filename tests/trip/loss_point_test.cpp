// Points at which motions are lost, and the trips that start there.

#include "graze/trip/loss_point.hpp"

#include "graze/base/input_error.hpp"
#include "graze/trip/disturbed_trip.hpp"
#include "graze/trip/overshoot_trip.hpp"
#include "grazing/linear_oscillator.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::loss_point_test {

using namespace graze::testing;

/// An oscillator that just touches its stop with a force of 1, as a point of a branch.
struct Touching {
    explicit Touching(const LinearOscillator& one) : model(one.model()) { point.solution.orbit = one.orbit(model); }
    LossPoint lost_by(const std::vector<const char*>& names) const {
        std::vector<ParameterId> candidates;
        for (const char* name : names)
            candidates.push_back(model.independent_parameter(name));
        return loss_point(System(model), point, candidates, "the orbit at GR1");
    }
    Model model;
    SpecialPoint point;
};

LinearOscillator oscillator() {
    return one_degree(0.05, 1.3, 0.8);
}

std::string problem_of(const Touching& one, const std::vector<const char*>& names) {
    try {
        one.lost_by(names);
    } catch (const InputError& error) {
        return error.problem();
    }
    return "";
}

TEST(LossPoint, TouchUsesTheFirstParameterThatMovesTheOrbit) {
    const Touching one(oscillator());
    const LossPoint lost = one.lost_by({"force"});
    EXPECT_STREQ(lost.kind(), "touch");
    EXPECT_EQ(lost.name, "force");
    EXPECT_EQ(lost.value, 1);
    EXPECT_EQ(lost.side, 1); // a greater force reaches farther
    EXPECT_NEAR(lost.cycle, oscillator().period(), 1e-12);
    EXPECT_GT(lost.level, 0);
    EXPECT_EQ(level_until(lost, {}), lost.level);
    TripEnd soft;
    soft.speed = 0.5 * lost.level;
    EXPECT_EQ(level_until(lost, soft), soft.speed);
    EXPECT_EQ(problem_of(one, {}), "no parameter is given that moves the orbit from its touch");
}

TEST(LossPoint, OrbitWithoutTouchIsRefusedByItsName) {
    Touching one(oscillator());
    one.point.solution.orbit.parameters[one.model.independent_parameter("sigma").place()] *= 2;
    EXPECT_EQ(problem_of(one, {"force"}), "the orbit at GR1 touches nothing");
}

TEST(LossPoint, TouchStartsTripsOfAllKinds) {
    const LossPoint lost = Touching(oscillator()).lost_by({"force"});
    constexpr double overshoot = 1e-4;
    TripEnd end;
    end.speed = lost.level;
    const OvershootTrip trip =
        trip_of_touch(lost.system, lost.map, lost.verdict, lost.parameter, overshoot, level_until(lost, end), end);
    ASSERT_TRUE(trip.predicted && trip.continued && trip.simulated);
    ASSERT_NE(trip.best(), nullptr);
    EXPECT_EQ(trip.best(), &*trip.simulated);
    EXPECT_NEAR(trip.simulated->time, trip.continued->time, 1e-3 * lost.cycle);
    const OvershootTrip unseen =
        trip_of_touch(lost.system, lost.map, lost.verdict, lost.parameter, 1e-40, level_until(lost, end), end);
    EXPECT_FALSE(unseen.simulated);
    EXPECT_EQ(unseen.best(), &*unseen.continued);
    EXPECT_EQ(trip_origin(lost, 0.9).point, 1);
    EXPECT_LT(beginning_of_ramp(lost, 1e-6), 1);
}

} // namespace graze::loss_point_test
