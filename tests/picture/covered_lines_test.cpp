#include "picture/covered_lines.hpp"

#include <gmock/gmock.h>

namespace graze::testing {

using ::testing::ElementsAre;

namespace {

std::vector<std::size_t> counts_of(const std::vector<FigureSeries>& series) {
    FigurePanel panel;
    panel.series = series;
    PanelLayout layout;
    layout.frame = {0, 0, 300, 200};
    return covering_lines(panel, layout);
}

FigureSeries line(std::size_t colour, std::vector<PlanePoint> points) {
    return {"", FigureSeries::Style::line, colour, std::move(points)};
}

} // namespace

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

} // namespace graze::testing
