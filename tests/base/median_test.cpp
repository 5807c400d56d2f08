#include "base/median.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

TEST(Median, is_the_middle_one_or_the_upper_of_two) {
    EXPECT_EQ(median({4}), 4);
    EXPECT_EQ(median({3, -1, 2}), 2);
    EXPECT_EQ(median({5, 1, 1, 7}), 5);
}

} // namespace
} // namespace graze
