#include "program/label_places.hpp"

#include <gmock/gmock.h>

namespace graze::testing {

using ::testing::ElementsAre;

namespace {

const Box frame{0, 0, 300, 200};

LabelPlaces places_of(const FigurePanel& panel) {
    return place_labels(panel, frame, panel_axis(panel, true, 300, 9), panel_axis(panel, false, 200, 9), 9);
}

FigurePanel unit_panel() {
    FigurePanel panel;
    panel.x_range = panel.y_range = std::pair(0.0, 1.0);
    return panel;
}

} // namespace

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

TEST(LabelPlaces, LinesLeadToLabelsThatStandOff) {
    FigurePanel panel = unit_panel();
    FigureSeries symbols{"", FigureSeries::Style::symbols, 0, {}};
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 5; ++k) { // a crowd of symbols around the point in the middle
            symbols.points.push_back({0.5 + 0.02 * (i - 2), 0.5 + 0.03 * (k - 2)});
        }
    panel.series = {symbols};
    panel.labels = {{{0.5, 0.5}, "SN1"}};
    const LabelPlaces places = places_of(panel);
    ASSERT_EQ(places.labels.size(), 1U);
    EXPECT_TRUE(places.labels[0].led);
    for (const Box& mark : places.marks)
        EXPECT_FALSE(places.labels[0].box.meets(mark));
}

TEST(LabelPlaces, OfTooManyTheMostImportantStay) {
    FigurePanel panel = unit_panel();
    for (int i = 0; i < 150; ++i)
        panel.labels.push_back({{0.1 + 5e-3 * i, 0.5}, "EX" + std::to_string(i), 0, i % 50 == 25 ? 0 : 2});
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

TEST(LabelPlaces, KeepOffCurvesWhereThereIsRoom) {
    FigurePanel panel = unit_panel();
    panel.series.push_back({"", FigureSeries::Style::line, 0, {{0, 0.5}, {1, 0.6}}});
    panel.series.push_back({"", FigureSeries::Style::line, 0, {{0, 0.45}, {1, 0.65}}});
    panel.labels = {{{0.5, 0.55}, "BP1"}};
    const PlacedLabel label = places_of(panel).labels.at(0);
    // Neither line runs through the box.
    for (double x = label.box.left; x <= label.box.right; x += 0.5)
        for (const double y : {200 * (0.5 + 0.1 * x / 300), 200 * (0.45 + 0.2 * x / 300)})
            EXPECT_FALSE(label.box.holds(PlanePoint{x, y})) << x;
}

} // namespace graze::testing
