#include "picture/label_places.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace graze::testing::label_places_test {

using ::testing::ElementsAre;

const Box frame{0, 0, 300, 200};

LabelPlaces places_of(const FigurePanel& panel) {
    return place_labels(panel, frame, panel_axis(panel, true, 300, 9), panel_axis(panel, false, 200, 9), 9);
}

FigurePanel unit_panel() {
    FigurePanel panel;
    panel.x_range = panel.y_range = std::pair(0.0, 1.0);
    return panel;
}

TEST(LabelPlaces, ALabelStandsAtItsPoint) {
    FigurePanel panel = unit_panel();
    panel.labels = {{{0.5, 0.5}, "SN1"}};
    const LabelPlaces places = places_of(panel);
    ASSERT_EQ(places.labels.size(), 1U);
    EXPECT_FALSE(places.labels[0].led);
    EXPECT_EQ(places.labels[0].point.x, 150);
    EXPECT_FALSE(places.labels[0].box.holds(places.labels[0].point));
    EXPECT_TRUE(places.labels[0].box.grown(mark_size(9)).holds(places.labels[0].point));
}

TEST(LabelPlaces, OneLabelStandsWherePointsCoincide) {
    FigurePanel panel = unit_panel();
    panel.labels = {{{0.5, 0.5}, "SN1"}, {{0.5, 0.5}, "SN1"}, {{0.5, 0.5 + 1e-4}, "GR2"}, {{0.2, 0.2}, "SN1"}};
    const LabelPlaces places = places_of(panel);
    std::vector<std::string> texts;
    for (const PlacedLabel& label : places.labels)
        texts.push_back(label.text);
    EXPECT_THAT(texts, ElementsAre("SN1, GR2", "SN1"));
    EXPECT_EQ(places.omitted, 0U);
}

TEST(LabelPlaces, LabelsAwayFromTheirPointHaveLeaders) {
    FigurePanel panel = unit_panel();
    FigureSeries symbols{"", FigureSeries::Style::symbols};
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 5; ++k) // symbols around the point in the centre, between which a leader can pass
            symbols.points.push_back({0.5 + 0.045 * (i - 2), 0.5 + 0.07 * (k - 2)});
    panel.series = {symbols};
    panel.labels = {{{0.5, 0.5}, "SN1"}};
    const LabelPlaces places = places_of(panel);
    ASSERT_EQ(places.labels.size(), 1U);
    EXPECT_TRUE(places.labels[0].led);
    for (const Box& mark : places.marks)
        EXPECT_FALSE(places.labels[0].box.meets(mark));
}

TEST(LabelPlaces, AmbiguousLabelsAreListed) {
    FigurePanel panel = unit_panel();
    FigureSeries symbols{"", FigureSeries::Style::symbols};
    for (int i = 0; i < 9; ++i)
        for (int k = 0; k < 9; ++k) // symbols so dense that every leader would cross one
            symbols.points.push_back({0.5 + 0.012 * (i - 4), 0.5 + 0.018 * (k - 4)});
    panel.series = {symbols};
    panel.labels = {{{0.5, 0.5}, "SN1", 0, 0, "branch"}};
    const LabelPlaces places = places_of(panel);
    EXPECT_TRUE(places.labels.empty());
    EXPECT_THAT(places.notes, ElementsAre("without room for a label: SN1 (branch)"));
}

TEST(LabelPlaces, EachLabelIsNearestToItsOwnSymbol) {
    FigurePanel panel = unit_panel();
    FigureSeries symbols{"", FigureSeries::Style::symbols};
    for (int i = 0; i < 12; ++i) {
        const PlanePoint at{0.4 + 0.013 * i, 0.4 + 0.02 * ((7 * i) % 5)};
        symbols.points.push_back(at);
        panel.labels.push_back({at, "EX" + std::to_string(i + 1)});
    }
    panel.series = {symbols};
    const LabelPlaces places = places_of(panel);
    ASSERT_GT(places.labels.size(), 4U);
    const auto away = [](const Box& box, const PlanePoint& point) {
        return std::hypot(std::max({box.left - point.x, point.x - box.right, 0.0}),
                          std::max({box.low - point.y, point.y - box.high, 0.0}));
    };
    for (const PlacedLabel& label : places.labels)
        for (const PlanePoint& point : symbols.points) {
            const PlanePoint other{300 * point.x, 200 * point.y};
            if (distance_of(label.point, other) < mark_size(9) / 2)
                continue; // they have one label
            if (label.led)
                EXPECT_FALSE(
                    part_within(label.leader_start, label.leader_end, Box::around(other, mark_size(9), mark_size(9))))
                    << label.text;
            else
                EXPECT_LT(away(label.box, label.point), away(label.box, other)) << label.text;
        }
}

TEST(LabelPlaces, MergedLabelsAreBlackAndMoreThanThreeAreListed) {
    FigurePanel panel = unit_panel();
    panel.labels = {{{0.3, 0.3}, "GR1", 0}, {{0.3, 0.3}, "SN1", 1}, {{0.6, 0.6}, "PD1", 2}, {{0.6, 0.6}, "PD2", 2}};
    for (int i = 1; i < 6; ++i)
        panel.labels.push_back({{0.8, 0.2}, "GR" + std::to_string(i), 3, 1, "G"});
    const LabelPlaces places = places_of(panel);
    ASSERT_EQ(places.labels.size(), 3U);
    EXPECT_EQ(places.labels[0].colour, FigureSeries::black);
    EXPECT_EQ(places.labels[1].colour, 2U);
    EXPECT_EQ(places.labels[2].text, "[1]");
    EXPECT_THAT(places.notes, ElementsAre("[1]: GR1 (G), GR2 (G), GR3 (G), GR4 (G), GR5 (G)"));
}

TEST(LabelPlaces, LabelsOfLowestRankArePlacedFirst) {
    FigurePanel panel = unit_panel();
    for (int i = 0; i < 150; ++i)
        panel.labels.push_back(
            {{0.02 + 0.0633 * (i % 15), 0.05 + 0.09 * (i / 15)}, "EX" + std::to_string(i), 0, i % 50 == 25 ? 0 : 2});
    const LabelPlaces places = places_of(panel);
    EXPECT_GT(places.labels.size(), 8U);
    EXPECT_LT(places.labels.size(), 31U);
    EXPECT_EQ(places.labels.size() + places.omitted, 150U);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(places.labels[i].text, "EX" + std::to_string(25 + 50 * i));
    const LabelPlaces again = places_of(panel);
    ASSERT_EQ(again.labels.size(), places.labels.size());
    for (std::size_t i = 0; i < places.labels.size(); ++i)
        EXPECT_EQ(again.labels[i].box.left, places.labels[i].box.left);
}

TEST(LabelPlaces, LabelsAvoidCurves) {
    FigurePanel panel = unit_panel();
    panel.series.push_back({"", FigureSeries::Style::line, 0, {{0, 0.5}, {1, 0.6}}});
    panel.series.push_back({"", FigureSeries::Style::line, 0, {{0, 0.45}, {1, 0.65}}});
    panel.labels = {{{0.5, 0.55}, "BP1"}};
    const PlacedLabel label = places_of(panel).labels.at(0);
    // Neither line crosses the box.
    for (double x = label.box.left; x <= label.box.right; x += 0.5)
        for (const double y : {200 * (0.5 + 0.1 * x / 300), 200 * (0.45 + 0.2 * x / 300)})
            EXPECT_FALSE(label.box.holds(PlanePoint{x, y})) << x;
}

} // namespace graze::testing::label_places_test
