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

TEST(JoinedCells, AreThoseOfStoredPointsOnly) {
    FigureSeries bars{.style = FigureSeries::Style::cells};
    bars.cells = {{0, 1, 0, 5}, {1, 2, 0, 5}};
    EXPECT_EQ(joined_cells(bars).size(), 2U);
}

} // namespace graze::joined_cells_test
