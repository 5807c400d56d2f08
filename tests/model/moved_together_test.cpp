#include "model/moved_together.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace graze::moved_together_test {

using Sets = std::vector<std::vector<std::size_t>>;

TEST(MovedTogether, StatesOfWhichOnlyDifferencesMatter) {
    EXPECT_EQ(sets_moved_together({1, -1, 0, 0, 0, 3}, 3), (Sets{{0, 1}}));
    EXPECT_EQ(sets_moved_together({1, -1, 0, 0, 2, -2}, 3), (Sets{{0, 1, 2}}));
    EXPECT_EQ(sets_moved_together({1, 0, -1, 0, 0, 1, 0, -1}, 4), (Sets{{0, 2}, {1, 3}}));
    // Another multiple of a state, and a state on which nothing depends.
    EXPECT_EQ(sets_moved_together({1, -2}, 2), Sets{});
    EXPECT_EQ(sets_moved_together({1, 0}, 2), Sets{});
    EXPECT_EQ(sets_moved_together({}, 2), Sets{});
    // What is not defined does not count.
    EXPECT_EQ(sets_moved_together({1, -1, std::numeric_limits<double>::quiet_NaN(), 1}, 2), (Sets{{0, 1}}));
}

} // namespace graze::moved_together_test
