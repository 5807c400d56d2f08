#include "graze/study/part_sizes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace graze::part_sizes_test {

/// Parts are multiples of the number of motions that a core computes at once.
constexpr std::size_t most_together = 32;

TEST(PartSizes, BeginWithSingleItemsAndGrow) {
    PartSizes sizes({{0, 100000}});
    EXPECT_FALSE(sizes.is_brief());
    EXPECT_EQ(sizes.cut(4).size(), 1U);
    EXPECT_EQ(sizes.cut(4).size(), 1U); // nothing is known yet
    sizes.note(1, 1e-3);
    EXPECT_TRUE(sizes.is_brief());
    std::size_t size = sizes.cut(4).size(), largest = 1;
    EXPECT_EQ(size, 8U);
    while (size > largest) {
        EXPECT_LE(size, 8 * largest);
        sizes.note(size, 1e-3 * static_cast<double>(size));
        largest = size;
        size = sizes.cut(4).size();
    }
    EXPECT_LE(size, 500U); // half a second
    EXPECT_GE(size, 500U - most_together);
}

TEST(PartSizes, AreSingleItemsThatTakeLong) {
    PartSizes sizes({{0, 100}});
    sizes.cut(2);
    sizes.note(1, 5);
    EXPECT_FALSE(sizes.is_brief());
    EXPECT_EQ(sizes.cut(2).size(), 1U);
}

TEST(PartSizes, ShrinkNearTheEnd) {
    PartSizes sizes({{0, 1600}});
    sizes.note(1000, 1);
    for (std::size_t left = 1600; sizes.has_more();) {
        const std::size_t size = sizes.cut(2).size();
        const std::size_t share = std::max<std::size_t>(left / 4, 100); // the least is a fifth of half a second
        EXPECT_LE(size, share);
        EXPECT_GE(size, std::min(left, share - most_together));
        left -= size;
    }
}

TEST(PartSizes, CutEachItemOnce) {
    const std::vector<ItemRange> missing{{0, 3}, {10, 11}, {20, 1000}};
    PartSizes sizes(missing);
    std::vector<std::size_t> items;
    for (std::size_t part = 0; sizes.has_more(); ++part) {
        const ItemRange range = sizes.cut(3);
        ASSERT_GT(range.size(), 0U);
        for (std::size_t item = range.first; item < range.last; ++item)
            items.push_back(item);
        sizes.note(range.size(), 1e-4 * static_cast<double>(part));
    }
    std::vector<std::size_t> all;
    for (const ItemRange& range : missing)
        for (std::size_t item = range.first; item < range.last; ++item)
            all.push_back(item);
    EXPECT_EQ(items, all);
}

} // namespace graze::part_sizes_test
