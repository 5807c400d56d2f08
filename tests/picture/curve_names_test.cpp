#include "picture/curve_names.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::curve_names_test {

const Box view{0, 0, 10, 100};

TEST(CurveNames, StandOnTheirCurvesFarFromOthers) {
    const std::vector<Polyline> rising{{{0, 0}, {10, 100}}}, falling{{{0, 100}, {10, 0}}};
    const auto places = places_of_names({rising, falling}, {{1, 10}}, view);
    ASSERT_EQ(places.size(), 2U);
    ASSERT_TRUE(places[0] && places[1]);
    EXPECT_NEAR(places[0]->y, 10 * places[0]->x, 1e-9);
    EXPECT_NEAR(places[1]->y, 100 - 10 * places[1]->x, 1e-9);
    for (const auto& place : places)
        EXPECT_GT(std::abs(place->x - 5), 0.5); // the crossing
    EXPECT_GT(std::abs(places[0]->x - 1), 1);   // a point with a label of its own
}

TEST(CurveNames, NeedAPartOfTheCurveInTheView) {
    const auto places = places_of_names({{{{-3, 0}, {-1, 50}}}, {{{-5, 50}, {1, 50}}}, {}}, {}, view);
    ASSERT_EQ(places.size(), 3U);
    EXPECT_FALSE(places[0]);
    ASSERT_TRUE(places[1]);
    EXPECT_GE(places[1]->x, 0);
    EXPECT_LE(places[1]->x, 1);
    EXPECT_FALSE(places[2]);
}

} // namespace graze::curve_names_test
