#include "picture/curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace graze::testing::curve_test {

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

TEST(Curve, SimplifiedStaysClose) {
    Polyline line;
    for (int i = 0; i <= 2000; ++i)
        line.push_back({0.01 * i, 3 * std::sin(0.01 * i)});
    const double distance = 1e-3;
    const Polyline short_line = simplified(line, 20, 6, distance);
    EXPECT_LT(short_line.size(), 120U);
    EXPECT_EQ(short_line.front().x, line.front().x);
    EXPECT_EQ(short_line.back().x, line.back().x);
    std::size_t piece = 0;
    for (const PlanePoint& point : line) {
        while (short_line[piece + 1].x < point.x)
            ++piece;
        const PlanePoint a = short_line[piece], b = short_line[piece + 1];
        const double on_line = a.y + (b.y - a.y) * (point.x - a.x) / (b.x - a.x);
        // Vertical distances exceed perpendicular ones by the slope, here at most 3 * 20/6.
        EXPECT_LE(std::abs(on_line - point.y) / 6, distance * std::hypot(1, 10) * (1 + 1e-12));
    }
}

TEST(Curve, SimplifiedKeepsEndsAndTurningPoints) {
    EXPECT_TRUE(simplified({}, 1, 1, 0.1).empty());
    const Polyline two{{0, 0}, {1, 1}};
    EXPECT_EQ(simplified(two, 1, 1, 0.1).size(), 2U);
    const Polyline back{{0, 0}, {1, 0}, {0, 0}};
    EXPECT_EQ(simplified(back, 1, 1, 0.1).size(), 3U) << "a line there and back is not a point";
}

TEST(Curve, AxesHaveRoundTics) {
    const Axis axis = axis_for(-0.61, 0.74, 4, 0.08);
    EXPECT_LT(axis.low, -0.61);
    EXPECT_GT(axis.high, 0.74);
    EXPECT_DOUBLE_EQ(axis.tic, 0.2);
    EXPECT_DOUBLE_EQ(axis_for(0, 3.2, 6, 0).tic, 0.5);
    EXPECT_DOUBLE_EQ(axis_for(0, 1e-7, 5, 0).tic, 2e-8);
    const Axis constant = axis_for(5, 5, 4, 0.1);
    EXPECT_LT(constant.low, 5);
    EXPECT_GT(constant.high, 5);
    const Axis zero = axis_for(0, 0, 4, 0.1);
    EXPECT_LT(zero.low, zero.high);
    const Axis nothing = axis_for(INFINITY, -INFINITY, 4, 0.1);
    EXPECT_LT(nothing.low, nothing.high);
}

// A circle through 24 points: directions at extrema are exact, others are harmonic means of slopes.
TEST(Curve, SmoothedIsCloserToACircleThanChords) {
    Polyline line;
    std::vector<double> along;
    const double step = 2 * std::numbers::pi / 24;
    for (int i = 0; i <= 24; ++i) {
        line.push_back({std::cos(step * i), std::sin(step * i)});
        along.push_back(step * i);
    }
    const Polyline curve = smoothed(line, along, {});
    ASSERT_EQ(curve.size(), 24U * 8 + 1);
    const double sagitta = 1 - std::cos(step / 2);
    double farthest = 0, least = 1;
    for (std::size_t i = 8; i + 8 < curve.size(); ++i) { // without the first and last interval
        farthest = std::max(farthest, std::abs(std::hypot(curve[i].x, curve[i].y) - 1));
        EXPECT_LE(std::abs(curve[i].x), 1);
        EXPECT_LE(std::abs(curve[i].y), 1);
        least = std::min(least, curve[i].x);
    }
    EXPECT_LT(farthest, sagitta / 3);
    EXPECT_EQ(least, -1);
    for (std::size_t i = 0; i < line.size(); ++i)
        EXPECT_EQ(curve[8 * i].x, line[i].x);
}

TEST(Curve, SmoothedKeepsCornersAndGaps) {
    const Polyline line{{0, 0}, {1, 1}, {2, 0}, {3, 1}};
    const std::vector<double> along{0, 1, 2, 3};
    for (const PlanePoint& point : smoothed(line, along, std::vector<std::size_t>{1, 2}))
        EXPECT_NEAR(point.y, point.x <= 1 ? point.x : point.x <= 2 ? 2 - point.x : point.x - 2, 1e-14);
    EXPECT_EQ(smoothed(line, {}, {}).size(), 4U);
    EXPECT_EQ(smoothed(line, std::vector<double>(4, 0.0), {}).size(),
              4U); // arclengths that do not increase are not used
    const double nothing = std::nan("");
    const Polyline gap{{0, 0}, {1, 0}, {nothing, nothing}, {2, 0}, {3, 0}};
    const Polyline curve = smoothed(gap, std::vector<double>{0, 1, 2, 3, 4}, {});
    EXPECT_EQ(std::count_if(curve.begin(), curve.end(), [](const PlanePoint& p) { return std::isnan(p.x); }), 1);
}

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

} // namespace graze::testing::curve_test
