#include "layout/turned_box.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace graze::testing::turned_box_test {

constexpr double degree = std::numbers::pi / 180;

TEST(TurnedBox, MeetsBoxesThatNoSideSeparates) {
    const TurnedBox square({-500, -500, 500, 500}, {}, 0);
    // Rotated by 45 degrees it reaches 707 to the right.
    const TurnedBox diamond({-500, -500, 500, 500}, {1200, 0}, 45 * degree);
    EXPECT_TRUE(square.meets(diamond));
    EXPECT_FALSE(square.meets(TurnedBox({-500, -500, 500, 500}, {1210, 0}, 45 * degree)));
    EXPECT_FALSE(square.meets(TurnedBox({-500, -500, 500, 500}, {1000, 0}, 0))) << "they only touch";
    // Their corners are apart in x and y, but not along the diagonal; and vice versa.
    EXPECT_FALSE(square.meets(TurnedBox({-500, -500, 500, 500}, {860, 860}, 45 * degree)));
    EXPECT_TRUE(square.meets(TurnedBox({-500, -500, 500, 500}, {840, 840}, 45 * degree)));
    EXPECT_TRUE(square.meets(TurnedBox({-10, -10, 10, 10}, {}, 30 * degree))) << "one within the other";
    EXPECT_TRUE(TurnedBox({-10, -10, 10, 10}, {}, 30 * degree).meets(square));
}

} // namespace graze::testing::turned_box_test
