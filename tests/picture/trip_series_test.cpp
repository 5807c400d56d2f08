#include "graze/picture/trip_series.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::trip_series_test {

TripTime trip(double time, std::size_t contacts) {
    TripTime result;
    result.ended = true;
    result.time = time;
    result.contacts = contacts;
    return result;
}

TEST(TripSeries, JoinsOnlyTripsWithEqualNumbersOfContacts) {
    FigurePanel panel;
    add_trips(panel, {{1e-2, trip(5, 3)}, {1e-3, trip(5.1, 3)}, {1e-4, trip(11, 4)}}, "map", 0, 9);
    ASSERT_EQ(panel.series.size(), 2U);
    const FigureSeries &line = panel.series[0], &marks = panel.series[1];
    ASSERT_EQ(line.points.size(), 4U);
    EXPECT_EQ(line.points[1].y, 5.1);
    EXPECT_TRUE(std::isnan(line.points[2].y)); // a gap: the time jumps with the number of contacts
    EXPECT_EQ(line.points[3].y, 11);
    EXPECT_EQ(marks.points.size(), 3U);
    EXPECT_EQ(marks.title, "map");
    EXPECT_TRUE(line.title.empty());
}

TEST(TripSeries, JoinsAllTripsAtAFold) {
    FigurePanel panel;
    add_trips(panel, {{1e-2, trip(5, 3)}, {1e-4, trip(50, 40)}}, "normal form", 0, 9, true);
    ASSERT_EQ(panel.series.size(), 2U);
    EXPECT_EQ(panel.series[0].points.size(), 2U);
}

TEST(TripSeries, NoTripsGiveNoSeries) {
    FigurePanel panel;
    add_trips(panel, {}, "map", 0, 9);
    EXPECT_TRUE(panel.series.empty());
}

} // namespace graze::trip_series_test
