#include "picture/panel_axis.hpp"

#include "graze/base/input_error.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <utility>

namespace graze::testing::panel_axis_test {

FigurePanel panel_between(double low, double high) {
    FigurePanel panel;
    panel.x_range = panel.y_range = std::pair(low, high);
    return panel;
}

std::string texts_of(const PanelAxis& axis) {
    std::string texts;
    for (const PanelAxis::Tic& tic : axis.tics)
        texts += letters_of(tic.text) + ' ';
    return texts;
}

TEST(PanelAxis, LabelsHaveTheNecessaryDigits) {
    EXPECT_EQ(texts_of(panel_axis(panel_between(0, 1), true, 300, 9)), "0.0 0.2 0.4 0.6 0.8 1.0 ");
    EXPECT_EQ(texts_of(panel_axis(panel_between(-2, 2), false, 200, 9)), "−2.0 −1.5 −1.0 −0.5 0.0 0.5 1.0 1.5 2.0 ");
    EXPECT_EQ(texts_of(panel_axis(panel_between(4.832, 4.834), true, 200, 9)), "4.8320 4.8325 4.8330 4.8335 4.8340 ");
}

TEST(PanelAxis, SmallAndLargeNumbersHaveAPowerOfTen) {
    const PanelAxis small = panel_axis(panel_between(0, 4e-6), true, 300, 9);
    EXPECT_EQ(small.power, -6);
    EXPECT_EQ(texts_of(small), "0.0 0.5 1.0 1.5 2.0 2.5 3.0 3.5 4.0 ");
    EXPECT_EQ(panel_axis(panel_between(0, 2e7), true, 300, 9).power, 7);
}

TEST(PanelAxis, RefusesRangesThatCannotBeDrawn) {
    const double infinite = std::numeric_limits<double>::infinity();
    for (const auto& [low, high] :
         {std::pair{-9e307, 9e307}, std::pair{-1.7e308, 1.7e308}, std::pair{0.0, 1e-310}, std::pair{-1e-310, 1.7e308},
          std::pair{0.0, infinite}, std::pair{1.0, 1.0}, std::pair{std::nan(""), 1.0}})
        EXPECT_THROW(panel_axis(panel_between(low, high), true, 300, 9), InputError) << low << ' ' << high;
    for (const auto& [low, high] : {std::pair{-1e200, 1e200}, std::pair{0.0, 1e-200}, std::pair{1.0, 1.0 + 4e-16}}) {
        const PanelAxis axis = panel_axis(panel_between(low, high), true, 300, 9);
        EXPECT_LE(axis.tics.size(), 30U) << low << ' ' << high;
    }
}

TEST(PanelAxis, LabelsDoNotOverlap) {
    for (const double length : {40.0, 80.0, 160.0, 400.0})
        for (const double low : {-1e4, 0.0, 4.83211})
            for (const bool horizontal : {true, false}) {
                const PanelAxis axis = panel_axis(panel_between(low, low + 0.123), horizontal, length, 9);
                for (std::size_t i = 1; i < axis.tics.size() && axis.tics.size() > 2; ++i) {
                    const double distance =
                        length * (axis.share(axis.tics[i].value) - axis.share(axis.tics[i - 1].value));
                    EXPECT_GT(distance, horizontal ? 9 * width_of(axis.tics[i].text) : 9) << length << ' ' << low;
                }
            }
}

TEST(PanelAxis, LogarithmicAxesHaveDecades) {
    FigurePanel panel = panel_between(1e-8, 1e-2);
    panel.logarithmic_x = true;
    const PanelAxis axis = panel_axis(panel, true, 300, 9);
    EXPECT_EQ(texts_of(axis), "10−8 10−7 10−6 10−5 10−4 10−3 10−2 ");
    EXPECT_NEAR(axis.share(1e-5), 0.5, 1e-12);
    EXPECT_TRUE(std::isnan(axis.share(-1)));
    panel.x_range = std::pair(2.0, 6.0); // less than a decade
    EXPECT_GE(panel_axis(panel, true, 300, 9).tics.size(), 3U);
}

TEST(PanelAxis, RangeIncludesAllData) {
    FigurePanel panel;
    panel.series.push_back({"", FigureSeries::Style::line, 0, {{1, 5}, {3, 9}, {std::nan(""), 100}}});
    const PanelAxis x = panel_axis(panel, true, 300, 9), y = panel_axis(panel, false, 300, 9);
    EXPECT_LT(x.low, 1);
    EXPECT_GT(x.high, 3);
    EXPECT_GT(x.low, 0.9);
    EXPECT_GT(y.high, 9);
    EXPECT_LT(y.high, 9.5);
    panel.series[0].points = {{2, 7}};
    EXPECT_NEAR(panel_axis(panel, true, 300, 9).share(2), 0.5, 1e-12);
    panel.series.clear();
    EXPECT_EQ(panel_axis(panel, true, 300, 9).high, 1);
}

} // namespace graze::testing::panel_axis_test
