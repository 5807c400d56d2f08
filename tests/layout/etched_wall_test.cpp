#include "graze/layout/etched_wall.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::etched_wall_test {

TEST(EtchedWall, NarrowsLinesAndWidensTrenches) {
    const EtchedWall wall{.bias = 0.3, .slope = 0.002};
    const EtchedWidth line = etched_line(wall, 8, 250), trench = etched_trench(wall, 8, 250);
    EXPECT_DOUBLE_EQ(line.top, 7.4);
    EXPECT_DOUBLE_EQ(line.bottom, 6.4); // 0.5 more on each side
    EXPECT_DOUBLE_EQ(trench.top, 8.6);
    EXPECT_DOUBLE_EQ(trench.bottom, 9.6);
    EXPECT_DOUBLE_EQ(trench.least(), 8.6);
    EXPECT_DOUBLE_EQ(line.least(), 6.4);
    EXPECT_DOUBLE_EQ(line.mean(), 8 - 2 * wall.mean_recess(250));
}

TEST(EtchedWall, HasTheMeanCubeOfALinearWidth) {
    const EtchedWidth straight{.top = 3, .bottom = 3}, wedge{.top = 0, .bottom = 2};
    EXPECT_DOUBLE_EQ(straight.mean_cube(), 27);
    EXPECT_DOUBLE_EQ(wedge.mean_cube(), 2); // integral of (2x)^3
    // Simpson's rule is exact for cubic polynomials.
    const EtchedWidth width{.top = 7.4, .bottom = 6.4};
    const double simpson = (std::pow(7.4, 3) + 4 * std::pow(6.9, 3) + std::pow(6.4, 3)) / 6;
    EXPECT_NEAR(width.mean_cube(), simpson, 1e-13 * simpson); // round-off of a few operations
}

} // namespace graze::etched_wall_test
