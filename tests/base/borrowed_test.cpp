#include "graze/base/borrowed.hpp"

#include <gtest/gtest.h>

namespace graze::borrowed_test {

TEST(Borrowed, SharesWithoutOwning) {
    int number = 1;
    {
        const std::shared_ptr<int> share = borrowed(number);
        const std::shared_ptr<int> copy = share;
        *copy = 2;
        EXPECT_EQ(share.get(), &number);
        EXPECT_EQ(share.use_count(), 0); // nothing is counted: a copy costs no more than a pointer
    }
    EXPECT_EQ(number, 2);
}

} // namespace graze::borrowed_test
