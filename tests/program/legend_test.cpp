#include "program/legend.hpp"

#include <gmock/gmock.h>

namespace graze::testing {

namespace {

FigurePanel panel_of(std::size_t runs) {
    FigurePanel panel;
    for (std::size_t r = 0; r < runs; ++r)
        panel.series.push_back({"run " + std::to_string(r), FigureSeries::Style::line, r, {{0, 0}, {1, 1}}});
    panel.series.push_back({"stable", FigureSeries::Style::line, FigureSeries::black, {}});
    panel.series.back().only_in_legend = true;
    return panel;
}

} // namespace

TEST(Legend, SaysHowManyItLeavesOut) {
    EXPECT_EQ(legend_entries(panel_of(9)).size(), 10U);
    const auto entries = legend_entries(panel_of(25));
    ASSERT_EQ(entries.size(), 10U);
    EXPECT_EQ(entries[7].title, "run 7");
    EXPECT_EQ(entries[8].title, "and 17 more");
    EXPECT_FALSE(entries[8].sampled);
    EXPECT_EQ(entries[9].title, "stable");
}

TEST(Legend, EachTitleStandsThereOnceAndWhatIsEmptyNever) {
    FigurePanel panel = panel_of(1);
    panel.series.push_back(panel.series[0]);
    panel.series.push_back({"nothing", FigureSeries::Style::dots, 3, {}});
    EXPECT_EQ(legend_entries(panel).size(), 2U);
}

TEST(Legend, EntriesStandBesideOneAnotherWithinTheRoom) {
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

} // namespace graze::testing
