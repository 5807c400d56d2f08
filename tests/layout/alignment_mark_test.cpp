#include "graze/layout/alignment_mark.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

namespace graze::testing::alignment_mark_test {

TEST(AlignmentMark, IsACrossBetweenSquares) {
    for (const std::int64_t size : {20, 21, 999, 300'000}) {
        const LayoutCell mark = alignment_mark("MARK", size);
        ASSERT_EQ(mark.shapes.size(), 5U);
        GridBox all = bounding_box(mark.shapes[0].polygon);
        for (const CellShape& one : mark.shapes) {
            EXPECT_FALSE(polygon_fault(one.polygon, 1));
            all = all.with(bounding_box(one.polygon));
        }
        EXPECT_EQ(all.width(), size);
        EXPECT_EQ(all.height(), size);
        // The cross is a twentieth of the size from each square to its right.
        EXPECT_EQ(mark.shapes[0].layer, mask_layers::back_marks);
        const auto apart = facing(mark.shapes[0].polygon, mark.shapes[1].polygon);
        ASSERT_TRUE(apart);
        EXPECT_EQ(apart->distance, size / 20);
    }
    EXPECT_THROW(alignment_mark("MARK", 19), InputError);
}

} // namespace graze::testing::alignment_mark_test
