#include "flow/cyclic.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace graze::cyclic_test {

TEST(Cyclic, ValuesAreReducedToTheirPeriod) {
    EXPECT_EQ(within_period(7.5, 2), 1.5);
    EXPECT_EQ(within_period(-0.5, 2), 1.5);
    EXPECT_EQ(within_period(2, 2), 0);
    EXPECT_EQ(within_period(-7.5, 0), -7.5);
    // A negative value below the resolution of the period must not become the period itself.
    EXPECT_EQ(within_period(-std::numeric_limits<double>::min(), 2), 0);
}

TEST(Cyclic, DifferencesAreReducedByWholePeriods) {
    EXPECT_EQ(without_turns(7.5, 2), -0.5);
    EXPECT_EQ(without_turns(-4, 2), 0);
    EXPECT_EQ(without_turns(7.5, 0), 7.5);
}

} // namespace graze::cyclic_test
