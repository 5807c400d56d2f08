#include "picture/interleaved_dots.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <utility>

namespace graze::testing {

namespace {

PanelLayout unit_square() {
    PanelLayout layout;
    layout.frame = {0, 0, 300, 200};
    return layout;
}

} // namespace

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
    for (const InterleavedDot& dot : interleaved_dots(panel, unit_square()))
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
    EXPECT_EQ(interleaved_dots(panel, unit_square()).size(), 2U);
}

} // namespace graze::testing
