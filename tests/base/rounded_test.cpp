#include "graze/base/rounded.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace graze::rounded_test {

TEST(Rounded, IsTheNearestDecimal) {
    EXPECT_EQ(rounded(0.1 + 0.2, 13), 0.3);
    EXPECT_EQ(rounded(123456.789, 6), 123457);
    EXPECT_EQ(rounded(-1.0 / 3, 3), -0.333);
    EXPECT_EQ(rounded(0.0, 6), 0);
    for (const double value : {1.0 / 3, 1e300 / 7, -1e-300 / 7})
        EXPECT_EQ(rounded(value, 17), value);
}

TEST(Rounded, KeepsExtremeAndNonFiniteValues) {
    constexpr double largest = std::numeric_limits<double>::max(), tiny = std::numeric_limits<double>::denorm_min();
    EXPECT_EQ(rounded(tiny, 6), tiny);
    EXPECT_NEAR(rounded(1.23456e-310, 3), 1.23e-310, 1e-315);
    EXPECT_TRUE(std::isfinite(rounded(largest, 1)));
    EXPECT_NEAR(rounded(largest, 6) / largest, 1, 1e-5);
    EXPECT_EQ(rounded(std::numeric_limits<double>::infinity(), 6), std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan(rounded(std::nan(""), 6)));
}

} // namespace graze::rounded_test
