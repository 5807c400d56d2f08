#include "picture/interleaved_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace graze::testing::interleaved_points_test {

PanelLayout layout_with(const Box& frame) { // both axes go from 0 to 1
    PanelLayout layout;
    layout.frame = frame;
    return layout;
}

const PanelLayout wide = layout_with({0, 0, 300, 200}), square = layout_with({0, 0, 200, 100});
constexpr double stroke_width = 1; // points

std::vector<InterleavedDot> crowd(std::size_t count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> share(0.01, 0.99);
    std::vector<InterleavedDot> dots;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = share(random);
        dots.push_back({{x, 0.1 + 0.3 * x * share(random)}, i % 2});
    }
    return dots;
}

FigurePanel panel_of(std::size_t series, std::size_t points) {
    FigurePanel panel;
    panel.series.emplace_back(); // dots beneath
    for (std::size_t s = 0; s < series; ++s) {
        FigureSeries& one = panel.series.emplace_back();
        one.style = FigureSeries::Style::symbols;
        one.symbol = s % 2 == 0 ? 1 : 2;
        for (std::size_t i = 0; i < points; ++i)
            one.points.push_back({static_cast<double>(i), 0});
    }
    return panel;
}

// The last dot at each point is visible.
TEST(InterleavedDots, ShowAllOverlappingSeries) {
    FigurePanel panel;
    panel.series.assign(2, {"", FigureSeries::Style::dots, 0, {}});
    for (int i = 0; i < 400; ++i)
        panel.series[0].points.push_back({0.05 + 0.0475 * (i % 20), 0.05 + 0.0475 * (i / 20)});
    for (int copy = 0; copy < 3; ++copy) // one series has three times as many dots
        for (const PlanePoint& point : panel.series[0].points)
            panel.series[1].points.push_back({point.x + 1e-4 * copy, point.y});
    std::map<std::pair<int, int>, std::size_t> seen;
    for (const InterleavedDot& dot : interleaved_dots(panel, wide))
        seen[{static_cast<int>(dot.at.x / 0.0475), static_cast<int>(dot.at.y / 0.0475)}] = dot.series;
    std::array<int, 2> counts{};
    for (const auto& [place, series] : seen)
        ++counts[series];
    // Binomial: 200 of 400 each, with a standard deviation of 10.
    EXPECT_EQ(counts[0] + counts[1], 400);
    EXPECT_GT(counts[0], 150);
    EXPECT_GT(counts[1], 150);
}

TEST(InterleavedDots, AreMergedAndWithinTheFrame) {
    FigurePanel panel;
    panel.series.push_back({"", FigureSeries::Style::dots, 0, {{0.5, 0.5}, {0.5 + 1e-6, 0.5}, {0.6, 0.5}, {1.5, 0.5}}});
    panel.series.push_back({"", FigureSeries::Style::circles, 0, {{0.1, 0.1}}});
    EXPECT_EQ(interleaved_dots(panel, wide).size(), 2U);
}

TEST(DotStrokes, CoverTheSameAreaAsTheDots) {
    const std::vector<InterleavedDot> dots = crowd(60'000);
    const std::vector<DotStroke> strokes = dot_strokes(dots, square, stroke_width);
    EXPECT_LT(strokes.size(), dots.size() / 3);
    // Bitmaps with squares of a quarter of a point: dots and strokes blacken the same squares, up to the rounding of
    // columns and the corners of strokes.
    constexpr double side = 0.25;
    using Squares = std::set<std::pair<int, int>>;
    Squares of_dots, of_strokes;
    const auto fill = [&](Squares& squares, double left, double right, double low, double high, const auto& has) {
        for (int c = static_cast<int>(left / side); c <= static_cast<int>(right / side); ++c)
            for (int r = static_cast<int>(low / side); r <= static_cast<int>(high / side); ++r)
                if (has((c + 0.5) * side, (r + 0.5) * side))
                    squares.insert({c, r});
    };
    for (const InterleavedDot& dot : dots) {
        const double x = 200 * dot.at.x, y = 100 * dot.at.y, radius = stroke_width / 2;
        fill(of_dots, x - radius, x + radius, y - radius, y + radius,
             [&](double a, double b) { return std::hypot(a - x, b - y) < radius; });
    }
    for (const DotStroke& stroke : strokes) {
        const double x = 200 * stroke.from.x, low = 100 * stroke.from.y, high = 100 * stroke.to.y;
        EXPECT_LT(std::abs(stroke.from.x - stroke.to.x), 1e-3); // vertical to the eye
        fill(of_strokes, x - stroke_width / 2, x + stroke_width / 2, low, high,
             [&](double a, double b) { return std::abs(a - x) < stroke_width / 2 && low < b && b < high; });
    }
    const auto missing = [](const Squares& some, const Squares& others, int near) {
        return static_cast<double>(std::count_if(some.begin(), some.end(), [&](const auto& one) {
            for (int c = -near; c <= near; ++c)
                for (int r = -near; r <= near; ++r)
                    if (others.contains({one.first + c, one.second + r}))
                        return false;
            return true;
        }));
    };
    EXPECT_EQ(missing(of_dots, of_strokes, 2), 0); // half a point
    EXPECT_EQ(missing(of_strokes, of_dots, 2), 0);
    const auto count = static_cast<double>(of_dots.size());
    EXPECT_NEAR(static_cast<double>(of_strokes.size()), count, 0.05 * count);
}

TEST(DotStrokes, ShowAllSeriesEqually) {
    std::array<double, 2> ink{};
    for (const DotStroke& stroke : dot_strokes(crowd(60'000), square, stroke_width))
        ink.at(stroke.series) += stroke.to.y - stroke.from.y;
    EXPECT_NEAR(ink[0] / ink[1], 1, 0.1);
}

TEST(DotStrokes, ASingleDotKeepsItsArea) {
    const std::vector<DotStroke> strokes =
        dot_strokes(std::vector<InterleavedDot>{{{0.5, 0.5}, 3}}, square, stroke_width);
    ASSERT_EQ(strokes.size(), 1U);
    EXPECT_NEAR((strokes[0].from.x + strokes[0].to.x) / 2, 0.5, 1e-12);
    EXPECT_NEAR(100 * (strokes[0].to.y - strokes[0].from.y), 0.78, 1e-9); // pi/4: the area of the dot
    EXPECT_EQ(strokes[0].series, 3U);
}

TEST(InterleavedCrosses, GroupsHaveConsecutiveSeries) {
    FigurePanel panel = panel_of(3, 1);
    EXPECT_EQ(last_of_crosses(panel, 0), 0U) << "dots";
    EXPECT_EQ(last_of_crosses(panel, 1), 3U);
    panel.series[2].symbol = 7;
    EXPECT_EQ(last_of_crosses(panel, 1), 1U) << "a disc is between";
}

/// Each of several coinciding series is on top at an equal share of the points, and no cross is lost.
TEST(InterleavedCrosses, EachSeriesIsOnTopEquallyOften) {
    for (const std::size_t series : {2U, 3U}) {
        constexpr std::size_t points = 60;
        const FigurePanel panel = panel_of(series, points);
        std::map<double, std::size_t> seen;
        std::map<std::size_t, std::size_t> drawn, on_top;
        for (const CrossLayer& layer : interleaved_crosses(panel, 1, series))
            for (const PlanePoint& point : layer.points) {
                seen[point.x] = layer.series;
                ++drawn[layer.series];
            }
        for (const auto& [x, last] : seen)
            ++on_top[last];
        for (std::size_t s = 1; s <= series; ++s) {
            EXPECT_EQ(drawn[s], points);
            EXPECT_EQ(on_top[s], points / series);
        }
    }
}

} // namespace graze::testing::interleaved_points_test
