#include "page/time_limit.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

TEST(TimeLimit, IsReachedInTimeOrWhenSomebodyElseSaysSo) {
    EXPECT_FALSE(time_limit(1000)());
    EXPECT_TRUE(time_limit(-1)());
    EXPECT_TRUE(time_limit(1000, [] { return true; })());
    EXPECT_FALSE(time_limit(1000, [] { return false; })());
}

} // namespace
} // namespace graze
