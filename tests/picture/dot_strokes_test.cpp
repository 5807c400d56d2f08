#include "picture/dot_strokes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

namespace graze::testing {

namespace {

constexpr double stroke_width = 1; // points

PanelLayout square() {
    PanelLayout layout;
    layout.frame = {0, 0, 200, 100}; // both axes go from 0 to 1
    return layout;
}

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

} // namespace

TEST(DotStrokes, CoverTheSameAreaAsTheDots) {
    const std::vector<InterleavedDot> dots = crowd(60'000);
    const std::vector<DotStroke> strokes = dot_strokes(dots, square(), stroke_width);
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
    for (const DotStroke& stroke : dot_strokes(crowd(60'000), square(), stroke_width))
        ink.at(stroke.series) += stroke.to.y - stroke.from.y;
    EXPECT_NEAR(ink[0] / ink[1], 1, 0.1);
}

TEST(DotStrokes, ASingleDotKeepsItsArea) {
    const std::vector<DotStroke> strokes =
        dot_strokes(std::vector<InterleavedDot>{{{0.5, 0.5}, 3}}, square(), stroke_width);
    ASSERT_EQ(strokes.size(), 1U);
    EXPECT_NEAR((strokes[0].from.x + strokes[0].to.x) / 2, 0.5, 1e-12);
    EXPECT_NEAR(100 * (strokes[0].to.y - strokes[0].from.y), 0.78, 1e-9); // pi/4: the area of the dot
    EXPECT_EQ(strokes[0].series, 3U);
}

} // namespace graze::testing
