// What people write of trips: numbers, and ends.

#include "graze/trip/trip_request.hpp"

#include "graze/base/input_error.hpp"
#include "grazing/linear_oscillator.hpp"

#include <gtest/gtest.h>

namespace graze::trip_request_test {

using namespace graze::testing;

struct Pushed {
    Model model = one_degree(0.05, 1.3, 0.8).model();
    LossPoint lost = [this] {
        SpecialPoint point;
        point.solution.orbit = one_degree(0.05, 1.3, 0.8).orbit(model);
        return loss_point(System(model), point, {model.independent_parameter("force")});
    }();
    std::vector<double> numbers(const std::vector<std::string>& items) const {
        return numbers_by_decades(model, items, "overshoot");
    }
};

TEST(TripRequest, DecadesAreThePowersOfTenThatPeopleWrite) {
    const Pushed one;
    EXPECT_EQ(one.numbers({"1e-2:1e-6"}), (std::vector{1e-2, 1e-3, 1e-4, 1e-5, 1e-6}));
    EXPECT_EQ(one.numbers({"-1e-6:-1e-4", "3"}), (std::vector{-1e-6, -1e-5, -1e-4, 3.0}));
    EXPECT_EQ(one.numbers({"2e-3:5e-5"}), (std::vector{2e-3, 2e-4}));
    EXPECT_EQ(one.numbers({"force/100"}), (std::vector{0.01}));
    for (const char* wrong : {"1e-2:-1e-3", "0:1", "1e-2:", "x", "nan", "1:2:3"})
        EXPECT_THROW(one.numbers({wrong}), InputError) << wrong;
    EXPECT_THROW(one.numbers({"1e300:1e-300", "1e300:1e-300"}), InputError); // 1202 numbers
}

TEST(TripRequest, EndsAreReadAsWritten) {
    const Pushed one;
    const NamedEnd level = read_end(one.lost, one.model.states.front().name + "=force/2", "until");
    EXPECT_TRUE(level.given);
    EXPECT_TRUE(level.end.quantity);
    EXPECT_EQ(level.end.level, 0.5);
    const NamedEnd itself = read_end(one.lost, "end", "until");
    EXPECT_FALSE(itself.end.quantity);
    EXPECT_EQ(itself.end.speed, 0);
    for (const char* wrong : {"", "force", "nothing=1", "force=", "=1"})
        EXPECT_THROW(read_end(one.lost, wrong, "until"), InputError) << wrong;
}

TEST(TripRequest, UnfinishedTripsAreTold) {
    const Pushed one;
    TripOptions options;
    options.cycles = 3;
    const NamedEnd far = read_end(one.lost, one.model.states.front().name + "=1e9", "until");
    const OvershootTrips trips = overshoot_trips(one.lost, far, {1e-6}, options);
    const std::vector<std::string> messages = unfinished_trips(trips, "wait");
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_NE(messages.front().find("overshoot 1e-06"), std::string::npos);
    EXPECT_NE(messages.front().find("; wait"), std::string::npos);
    EXPECT_TRUE(unfinished_trips(overshoot_trips(one.lost, usual_end(one.lost), {1e-6}), "wait").empty());
}

} // namespace graze::trip_request_test
