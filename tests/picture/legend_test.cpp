#include "picture/legend.hpp"

#include <gmock/gmock.h>

namespace graze::testing::legend_test {

FigurePanel panel_of(std::size_t runs) {
    FigurePanel panel;
    for (std::size_t r = 0; r < runs; ++r)
        panel.series.push_back({"run " + std::to_string(r), FigureSeries::Style::line, r, {{0, 0}, {1, 1}}});
    panel.series.push_back({"stable", FigureSeries::Style::line, FigureSeries::black, {}});
    panel.series.back().only_in_legend = true;
    return panel;
}

TEST(Legend, CountsEntriesThatAreLeftOut) {
    EXPECT_EQ(legend_entries(panel_of(24)).size(), 25U);
    const auto entries = legend_entries(panel_of(40));
    ASSERT_EQ(entries.size(), 25U);
    EXPECT_EQ(entries[22].title, "run 22");
    EXPECT_EQ(entries[23].title, "and 17 more");
    EXPECT_FALSE(entries[23].sampled);
    EXPECT_EQ(entries[24].title, "stable");
}

TEST(Legend, HasEachTitleOnceAndNoEmptySeries) {
    FigurePanel panel = panel_of(1);
    panel.series.push_back(panel.series[0]);
    panel.series.push_back({"nothing", FigureSeries::Style::dots, 3, {}});
    EXPECT_EQ(legend_entries(panel).size(), 2U);
}

TEST(Legend, ExplainsVerticalLines) {
    FigurePanel panel = panel_of(1);
    panel.marks_title = "period changes";
    EXPECT_EQ(legend_entries(panel).size(), 2U); // there are no vertical lines
    panel.marks = {0.5};
    ASSERT_EQ(legend_entries(panel).size(), 3U);
    EXPECT_EQ(legend_entries(panel).back().title, "period changes");
}

TEST(Legend, PanelsThatShareEntriesHaveOneLegend) {
    const auto of = [](const std::vector<std::string>& titles, std::size_t colour = 0) {
        FigurePanel panel;
        for (const std::string& title : titles)
            panel.series.push_back({title, FigureSeries::Style::dots, colour++, {{0, 0}}});
        return panel;
    };
    FigurePanel unsettled = of({"rising", "falling"});
    unsettled.series.push_back({"unsettled", FigureSeries::Style::symbols, FigureSeries::grey, {{0, 0}}});
    const auto joined = [](const std::vector<FigurePanel>& panels) {
        std::vector<std::vector<LegendEntry>> legends;
        for (const FigurePanel& panel : panels)
            legends.push_back(legend_entries(panel));
        return joined_legend(legends);
    };
    const auto all = joined({of({"rising", "falling"}), unsettled, FigurePanel()});
    ASSERT_TRUE(all);
    ASSERT_EQ(all->size(), 3U);
    EXPECT_EQ(all->at(2).title, "unsettled");
    EXPECT_FALSE(joined({of({"rising", "falling"}), of({"rising", "other"})})) << "one look with two titles";
    FigurePanel other_look = of({"rising"});
    other_look.series.push_back({"falling", FigureSeries::Style::dots, 5, {{0, 0}}});
    EXPECT_FALSE(joined({of({"rising", "falling"}), other_look})) << "one title with two looks";
    EXPECT_FALSE(joined({of({"rising"}), of({"other"}, 1)})) << "nothing in common";
    EXPECT_FALSE(joined({}));
}

TEST(Legend, EntriesFitTheWidthWithoutOverlap) {
    for (const double width : {100.0, 240.0, 480.0}) {
        auto entries = legend_entries(panel_of(9));
        const double height = place_legend(entries, 10, 200, width, 9);
        const Box room{10, 200 - height, 10 + width, 200};
        for (std::size_t i = 0; i < entries.size(); ++i) {
            EXPECT_TRUE(room.grown(1e-9).holds(entries[i].box));
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_FALSE(entries[i].box.meets(entries[k].box.grown(-1e-9))); // rows touch
        }
    }
}

} // namespace graze::testing::legend_test
