// Where things stand in pictures: measured from the boxes that are placed, for pictures of all shipped studies too.

#include "program/figure_layout.hpp"

#include "graze/study/picture.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/study_catalogue.hpp"
#include "layout_overlaps.hpp"
#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace graze::testing {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

/// A column of text, a page of text, and a slide.
const std::vector<FigureStyle> styles{{85, 0, 0, ""}, {170, 0, 0, ""}, {254, 143, 0, ""}, {85, 60, 7, ""}};

FigurePanel panel_with(std::size_t points) {
    FigurePanel panel;
    panel.title = "(a) a title that is rather long for a narrow column of text, and needs more than a line there";
    panel.x_label = "V0";
    panel.x_words = "amplitude of the voltage of the source";
    panel.x_unit = "V";
    panel.y_label = "q";
    panel.y_words = "displacement of the mass towards magnet and stop from its place of equilibrium";
    panel.y_unit = "m/s^2";
    panel.roomy_y = true;
    FigureSeries line{"free", FigureSeries::Style::line, 0, {}}, symbols{"", FigureSeries::Style::symbols, 0, {}};
    for (std::size_t i = 0; i < points; ++i) {
        const double x = static_cast<double>(i) / static_cast<double>(points);
        line.points.push_back({x, 1e-5 * (x - x * x)});
        symbols.points.push_back(line.points.back());
        panel.labels.push_back({line.points.back(), "SN" + std::to_string(i + 1)});
    }
    panel.series = {line, symbols};
    return panel;
}

/// A study with few points of each sweep, which is done in seconds.
Study quick(const std::string& name) {
    Study study = load_study(name);
    for (StudyRun& run : study.runs) {
        run.draws = std::min<std::size_t>(run.draws, 6);
        for (Variation& axis : run.axes) {
            constexpr std::size_t every = 68, few = 60; // 4.84 V, where a branch starts, is among them
            std::vector<double> kept;
            for (std::size_t i = 0; i<axis.values.size(); i += axis.values.size()> few ? every : 1)
                kept.push_back(axis.values[i]);
            axis.values = kept;
        }
    }
    return study;
}

} // namespace

TEST(FigureLayout, NothingLiesOnAnythingElse) {
    for (const FigureStyle& style : styles)
        for (const std::size_t points : {std::size_t{2}, std::size_t{12}, std::size_t{200}})
            for (const std::size_t panels : {std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
                Figure figure{
                    "Orbits of an oscillator with a stop, which meets it once or twice in each period", 2, {}};
                figure.panels.assign(panels, panel_with(points));
                figure.style = style;
                if (style.height == 0 || panels < 3) {
                    EXPECT_THAT(overlaps_of(layout_of(figure)), ElementsAre())
                        << style.width << ' ' << points << ' ' << panels;
                }
            }
}

TEST(FigureLayout, HasTheSizeThatWasAskedFor) {
    Figure figure{"", 1, {panel_with(3)}};
    figure.style = {85, 60, 7, ""};
    const FigureLayout page = layout_of(figure);
    constexpr double points_per_mm = 72 / 25.4;
    EXPECT_NEAR(page.width, 85 * points_per_mm, 1e-9);
    EXPECT_NEAR(page.height, 60 * points_per_mm, 1);
    EXPECT_EQ(page.font, 7);
}

TEST(FigureLayout, PanelsThatWouldBeTooNarrowStandBelowOneAnother) {
    Figure figure{"", 2, {panel_with(3), panel_with(3)}};
    figure.style.width = 170;
    EXPECT_EQ(layout_of(figure).panels[0].frame.low, layout_of(figure).panels[1].frame.low);
    figure.style.width = 85;
    EXPECT_GT(layout_of(figure).panels[0].frame.low, layout_of(figure).panels[1].frame.high);
}

TEST(FigureLayout, WhatAllPanelsSayTheLegendSaysOnce) {
    Figure figure{"", 2, {panel_with(3), panel_with(3)}};
    EXPECT_EQ(layout_of(figure).legend.size(), 1U);
    EXPECT_TRUE(layout_of(figure).panels[0].legend.empty());
    figure.panels[1].series[0].title = "held";
    EXPECT_TRUE(layout_of(figure).legend.empty());
    EXPECT_EQ(layout_of(figure).panels[1].legend.at(0).title, "held");
}

TEST(FigureLayout, LabelsOfAxesHaveUnitsAndPowersOfTen) {
    const FigureLayout page = layout_of({"", 1, {panel_with(3)}});
    std::string texts;
    for (const PlacedText& text : page.panels[0].texts)
        texts += letters_of(text.text) + '\n';
    EXPECT_THAT(texts, HasSubstr("amplitude of the voltage of the source V0 (V)"));
    EXPECT_THAT(texts, HasSubstr("(10−6 m/s2)")); // as 10^-6, and a raised 2
}

class ShippedPictures : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedPictures, NothingOverlapsAndNoNameIsRaw) {
    const Folder folder;
    const Study study = quick(GetParam());
    ResultFile file(folder / "results.sqlite", ResultFile::Access::write);
    run_study(study, file, {});
    for (StudyPicture picture : study.pictures)
        for (const FigureStyle& style : styles) {
            if (style.height > 0 && style.width < 100)
                continue; // as high as several panels need
            picture.style = style;
            const FigureLayout page = layout_of(make_picture(picture, file).figure);
            EXPECT_THAT(overlaps_of(page), ElementsAre()) << picture.name << " at " << style.width << " mm";
            for (const NamedBox& box : boxes_of(page))
                EXPECT_EQ(box.name.find('_'), std::string::npos) << picture.name << " shows " << box.name;
            for (const PanelLayout& panel : page.panels)
                EXPECT_LE(panel.legend.size(), 12U);
        }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedPictures, ::testing::ValuesIn(shipped_studies()), [](const auto& tested) {
    std::string name = tested.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

} // namespace graze::testing
