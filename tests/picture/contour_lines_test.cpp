#include "picture/contour_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

namespace graze::testing {

namespace {

ContourGrid grid_of(double (*value)(double, double)) {
    ContourGrid grid;
    for (int i = 0; i <= 20; ++i) {
        grid.x.push_back(0.1 * i);
        grid.y.push_back(10 + i);
    }
    for (const double y : grid.y)
        for (const double x : grid.x)
            grid.values.push_back(value(x, y));
    return grid;
}

} // namespace

TEST(ContourLines, AreStraightForAPlane) {
    const ContourGrid grid = grid_of([](double x, double y) { return 3 * x + y; });
    const std::vector<PlanePoint> line = contour_line(grid, 20.05);
    ASSERT_FALSE(line.empty());
    ASSERT_EQ(line.size() % 3, 0U);
    for (std::size_t i = 0; i < line.size(); ++i)
        if (i % 3 == 2)
            EXPECT_FALSE(std::isfinite(line[i].x));
        else
            EXPECT_NEAR(3 * line[i].x + line[i].y, 20.05, 1e-12);
}

// For such ranges the step between levels overflows, vanishes, or is lost in rounding.
TEST(ContourLines, LevelsAreFewForExtremeRanges) {
    for (const auto& [low, high] : {std::pair{-1.7e308, 1.7e308}, std::pair{-9e307, 9e307}, std::pair{0.0, 1e-310},
                                    std::pair{1.0, 1.0 + 1e-15}, std::pair{1e17, 1e17 + 64}}) {
        ContourGrid grid{{0, 1}, {0, 1}, {low, high, low, high}};
        EXPECT_LE(contour_levels(grid, 5).size(), 12U) << low << ' ' << high;
    }
}

TEST(ContourLines, LevelsAreRoundAndWithinTheRange) {
    const ContourGrid grid = grid_of([](double x, double y) { return 3 * x + y; }); // 10 to 36
    EXPECT_EQ(contour_levels(grid, 6), (std::vector<double>{15, 20, 25, 30, 35}));
    EXPECT_TRUE(contour_levels(grid_of([](double, double) { return 1.0; }), 6).empty());
    ContourGrid holes = grid;
    for (double& value : holes.values)
        value = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(contour_levels(holes, 6).empty());
    EXPECT_TRUE(contour_line(holes, 20).empty());
}

} // namespace graze::testing
