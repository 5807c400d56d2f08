#include "base/median.hpp"

#include <gtest/gtest.h>

namespace graze::median_test {

TEST(Median, IsTheMiddleOneOrTheUpperOfTwo) {
    EXPECT_EQ(median({4}), 4);
    EXPECT_EQ(median({3, -1, 2}), 2);
    EXPECT_EQ(median({5, 1, 1, 7}), 5);
}

} // namespace graze::median_test
