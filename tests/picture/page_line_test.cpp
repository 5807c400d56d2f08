#include "picture/page_line.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graze::testing::page_line_test {

using ::testing::ElementsAre;

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

std::vector<std::size_t> counts_of(const std::vector<FigureSeries>& series) {
    FigurePanel panel;
    panel.series = series;
    PanelLayout layout;
    layout.frame = frame;
    return covering_lines(panel, layout);
}

FigureSeries line(std::size_t colour, std::vector<PlanePoint> points) {
    return {"", FigureSeries::Style::line, colour, std::move(points)};
}

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

TEST(CoveredLines, LinesAlongLaterLinesAreCovered) {
    // Two curves that merge, with different points, and one that crosses both.
    EXPECT_THAT(counts_of({line(0, {{0.45, 0.4}, {0.5, 0.5}, {1, 0.5}}),
                           line(1, {{0, 1}, {0.5, 0.5}, {0.77, 0.5}, {1, 0.5}}), line(2, {{0.9, 0}, {0.7, 1}})}),
                ElementsAre(1, 0, 0));
}

TEST(CoveredLines, LinesThatAreMostlyVisibleAreNotCovered) {
    EXPECT_THAT(counts_of({line(0, {{0, 0}, {1, 0}}), line(1, {{0, 0.5}, {0.7, 0}, {1, 0}})}), ElementsAre(0, 0));
    // Half a point apart.
    EXPECT_THAT(counts_of({line(0, {{0, 0.5}, {1, 0.5}}), line(1, {{0, 0.503}, {1, 0.503}})}), ElementsAre(0, 0));
}

TEST(CoveredLines, LinesOfOneColourHaveOneCount) {
    EXPECT_THAT(counts_of({line(0, {{0.4, 0.4}, {0.5, 0.5}}), line(0, {{0.5, 0.5}, {1, 0.5}}),
                           line(1, {{0.5, 0.5}, {1, 0.5}}), line(2, {{0.5, 0.5}, {0.6, 0.5}, {1, 0.5}})}),
                ElementsAre(2, 2, 1, 0));
    EXPECT_THAT(counts_of({line(0, {{0, 0}, {1, 1}}), line(0, {{0, 0}, {1, 1}})}), ElementsAre(0, 0));
}

} // namespace graze::testing::page_line_test
