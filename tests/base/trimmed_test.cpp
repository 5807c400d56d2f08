#include "graze/base/trimmed.hpp"

#include <gtest/gtest.h>

namespace graze::trimmed_test {

TEST(Trimmed, RemovesBlanksAtBothEnds) {
    EXPECT_EQ(trimmed(" \ta b\t "), "a b");
    EXPECT_EQ(trimmed("a"), "a");
    EXPECT_EQ(trimmed(" \t "), "");
    EXPECT_EQ(trimmed(""), "");
    EXPECT_EQ(trimmed(" a\n"), "a\n");
    EXPECT_EQ(trimmed(" a\n", " \n"), "a");
}

} // namespace graze::trimmed_test
