#include "picture/interleaved_crosses.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>

namespace graze::testing {

namespace {

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

} // namespace

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

} // namespace graze::testing
