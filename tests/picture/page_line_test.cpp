#include "picture/page_line.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graze::testing {

namespace {

const Box frame{0, 0, 300, 200};
const DashPattern dashed = dash_pattern(FigureSeries::Style::dashed, 1);

double length_of(const Polyline& line) {
    double length = 0;
    for (std::size_t i = 1; i < line.size(); ++i)
        length += std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y);
    return length;
}

/// The fraction of a horizontal line that two sets of dashes cover together.
double covered(const std::vector<Polyline>& one, const std::vector<Polyline>& other) {
    std::size_t seen = 0;
    constexpr std::size_t places = 10'000;
    for (std::size_t i = 0; i < places; ++i) {
        const double x = 50 + 200 * static_cast<double>(i) / places;
        const auto holds = [&](const Polyline& dash) {
            return std::min(dash.front().x, dash.back().x) <= x && x <= std::max(dash.front().x, dash.back().x);
        };
        seen += std::any_of(one.begin(), one.end(), holds) || std::any_of(other.begin(), other.end(), holds) ? 1 : 0;
    }
    return static_cast<double>(seen) / places;
}

} // namespace

TEST(PageLine, DashesOfCoincidingLinesCoincide) {
    const auto one = dashes_of({{1, 100}, {299, 100}}, dashed, frame);
    const auto back = dashes_of({{297.3, 100}, {20.7, 100}, {3.1, 100}}, dashed, frame);
    EXPECT_NEAR(covered(one, back), dashed.dash / dashed.length(), 0.01);
    const auto dotted = dashes_of({{7.7, 100}, {290, 100}}, dash_pattern(FigureSeries::Style::dotted, 1), frame);
    EXPECT_LT(covered(one, dotted), 0.85); // not a solid line
}

TEST(PageLine, DashesHaveGapsAtEverySlope) {
    for (int degrees = 0; degrees < 180; degrees += 5) {
        const double angle = degrees * std::numbers::pi / 180;
        const auto dashes = dashes_of({{150 - 90 * std::cos(angle), 100 - 90 * std::sin(angle)},
                                       {150 + 90 * std::cos(angle), 100 + 90 * std::sin(angle)}},
                                      dashed, frame);
        double drawn = 0;
        for (const Polyline& dash : dashes) {
            EXPECT_LE(length_of(dash), dashed.dash * std::numbers::sqrt2 + 1e-9) << degrees;
            drawn += length_of(dash);
        }
        EXPECT_NEAR(drawn / 180, dashed.dash / dashed.length(), 0.03) << degrees;
    }
}

TEST(PageLine, DashesStayInTheFrame) {
    const auto dashes = dashes_of({{-1e6, 100}, {1e6, 100}}, dashed, frame);
    EXPECT_EQ(dashes.size(), static_cast<std::size_t>(std::ceil(300 / dashed.length())));
    EXPECT_TRUE(dashes_of({{-10, 0}, {-10, 100}}, dashed, frame).empty());
    EXPECT_TRUE(dashes_of({{10, 10}}, dashed, frame).empty());
    EXPECT_EQ(spread_along({{0, 10}, {100, 10}}, 40, 10, frame).size(), 3U);
    EXPECT_EQ(spread_along({{-100, 10}, {100, 10}}, 40, 10, frame).front().x, 10);
}

} // namespace graze::testing
