#include "flow/cyclic.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace graze {
namespace {

TEST(Cyclic, values_come_within_their_period) {
    EXPECT_EQ(within_period(7.5, 2), 1.5);
    EXPECT_EQ(within_period(-0.5, 2), 1.5);
    EXPECT_EQ(within_period(2, 2), 0);
    EXPECT_EQ(within_period(-7.5, 0), -7.5);
    // What is lower than 0 by less than the period can resolve is not the period itself.
    EXPECT_EQ(within_period(-std::numeric_limits<double>::min(), 2), 0);
}

TEST(Cyclic, differences_lose_whole_periods) {
    EXPECT_EQ(without_turns(7.5, 2), -0.5);
    EXPECT_EQ(without_turns(-4, 2), 0);
    EXPECT_EQ(without_turns(7.5, 0), 7.5);
}

} // namespace
} // namespace graze
