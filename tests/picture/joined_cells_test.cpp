#include "picture/joined_cells.hpp"

#include <gtest/gtest.h>

namespace graze::joined_cells_test {

TEST(JoinedCells, OfARowBecomeOneBox) {
    FigureSeries series{.style = FigureSeries::Style::cells};
    // Two rows: in the first a gap after the second cell, which occurs twice; in the second one cell above the gap.
    series.cells = {{0, 1, 0, 1}, {1, 3, 0, 1}, {1, 3, 0, 1}, {4, 5, 0, 1}, {3, 4, 1, 2}};
    series.numbers = {7, 3, 4, 5, 6};
    const std::vector<PlaneBox> joined = joined_cells(series);
    ASSERT_EQ(joined.size(), 3U);
    EXPECT_EQ(joined[0].left, 0);
    EXPECT_EQ(joined[0].right, 3);
    EXPECT_EQ(joined[1].left, 4);
    EXPECT_EQ(joined[2].low, 1);
    EXPECT_EQ(series.cells.size(), 5U);
}

TEST(JoinedCells, OfEqualRowsBecomeOneBox) {
    FigureSeries series{.style = FigureSeries::Style::cells};
    // Two equal rows and a shorter one; apart from them a cell, and one above it after a gap.
    series.cells = {{0, 1, 0, 1}, {1, 2, 0, 1}, {4, 5, 0, 1}, {0, 1, 1, 2}, {1, 2, 1, 2}, {0, 1, 2, 3}, {4, 5, 2, 3}};
    series.numbers = {1, 2, 3, 4, 5, 6, 7};
    const std::vector<PlaneBox> joined = joined_cells(series);
    ASSERT_EQ(joined.size(), 4U);
    EXPECT_EQ(joined[0].right, 2);
    EXPECT_EQ(joined[0].high, 2);
    EXPECT_EQ(joined[1].high, 1);
    EXPECT_EQ(joined[2].right, 1);
    EXPECT_EQ(joined[3].low, 2);
}

TEST(JoinedCells, AreThoseOfStoredPointsOnly) {
    FigureSeries bars{.style = FigureSeries::Style::cells};
    bars.cells = {{0, 1, 0, 5}, {1, 2, 0, 5}};
    EXPECT_EQ(joined_cells(bars).size(), 2U);
}

} // namespace graze::joined_cells_test
