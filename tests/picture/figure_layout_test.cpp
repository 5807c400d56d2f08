// Layout of pictures, checked by the boxes of their texts and symbols, also for the pictures of all shipped studies.

#include "picture/figure_layout.hpp"

#include "base/temporary_folder.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/study_catalogue.hpp"
#include "layout_overlaps.hpp"
#include "shipped/shipped_results.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>
#include <sstream>

namespace graze::testing::figure_layout_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A column of text, a page of text, and a slide.
const std::vector<FigureStyle> styles{{85, 0, 0, ""}, {170, 0, 0, ""}, {254, 143, 0, ""}, {85, 60, 7, ""}};

FigurePanel panel_with(std::size_t points) {
    FigurePanel panel{
        .title = "(a) a title that is rather long for a narrow column of text, and needs more than a line there",
        .x_label = "V0",
        .y_label = "q",
        .x_unit = "V",
        .y_unit = "m/s^2",
        .x_words = "amplitude of the voltage of the source",
        .y_words = "displacement of the mass towards magnet and stop from its place of equilibrium",
        .roomy_y = true};
    FigureSeries line{"free", FigureSeries::Style::line}, symbols{"", FigureSeries::Style::symbols};
    for (std::size_t i = 0; i < points; ++i) {
        const double x = static_cast<double>(i) / static_cast<double>(points);
        line.points.push_back({x, 1e-5 * (x - x * x)});
        symbols.points.push_back(line.points.back());
        panel.labels.push_back({line.points.back(), "SN" + std::to_string(i + 1)});
    }
    panel.series = {line, symbols};
    return panel;
}

/// All texts of a page: titles, those at axes, and of legends.
std::vector<RichText> texts_of(const FigureLayout& page) {
    std::vector<RichText> all;
    const auto add = [&](const std::vector<PlacedText>& texts, const std::vector<LegendEntry>& legend) {
        for (const PlacedText& text : texts)
            all.push_back(text.text);
        for (const LegendEntry& entry : legend)
            all.push_back(entry.text);
    };
    add(page.title, page.legend);
    for (const PanelLayout& panel : page.panels)
        add(panel.texts, panel.legend);
    return all;
}

/// A shipped study with few points in each sweep, which is computed in seconds.
Study quick(const std::string& name) {
    Study study = load_study(name);
    if (name.starts_with("microbeam"))
        return study; // of which all is computed for other tests too
    for (StudyRun& run : study.runs) {
        if (!run.has_motions())
            continue;
        run.motion().draws = std::min<std::size_t>(run.motion().draws, 6);
        for (Variation& axis : run.motion().axes) {
            constexpr std::size_t every = 68, few = 60; // keeps 4.84 V, where a branch starts
            std::vector<double> kept;
            for (std::size_t i = 0; i<axis.values.size(); i += axis.values.size()> few ? every : 1)
                kept.push_back(axis.values[i]);
            axis.values = kept;
        }
    }
    return study;
}

/// Names with digits or underscores of parameters, states, modes and runs that a picture shows as they are in files.
std::vector<std::string> raw_names(const FigureLayout& page, const Study& study, const StudyPicture& picture) {
    std::set<std::string> names;
    const auto add = [&](const std::string& name) {
        if (name.find_first_of("_0123456789") != std::string::npos)
            names.insert(name);
    };
    const auto add_all = [&](const auto& list) {
        for (const auto& one : list)
            add(one.name);
    };
    for (const std::string& run : picture.runs) {
        add(run);
        const Model& model = study.find_run(run)->model;
        add_all(model.parameters);
        add_all(model.states);
        add_all(model.modes);
        add_all(model.events);
        add_all(model.sections);
        for (const Transition& transition : model.transitions)
            add(transition.label);
    }
    std::vector<std::string> found;
    const auto search = [&](const RichText& text) {
        for (const TextRun& run : text) {
            if (run.look != TextRun::Look::upright)
                continue;
            std::string words = run.text;
            std::replace_if(
                words.begin(), words.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '_'; }, ' ');
            std::istringstream stream(words);
            for (std::string word; stream >> word;)
                if (names.contains(word) || word.find('_') != std::string::npos)
                    found.push_back(word + " in " + letters_of(text));
        }
    };
    for (const RichText& text : texts_of(page))
        search(text);
    for (const PanelLayout& panel : page.panels)
        for (const PlacedLabel& label : panel.labels.labels)
            search(rich(label.text));
    return found;
}

TEST(FigureLayout, NothingOverlaps) {
    for (const FigureStyle& style : styles)
        for (const std::size_t points : {std::size_t{2}, std::size_t{12}, std::size_t{200}})
            for (const std::size_t panels : {std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
                const Figure figure{"Orbits of an oscillator with a stop, which meets it once or twice in each period",
                                    2, std::vector(panels, panel_with(points)), style};
                if (style.height == 0 || panels < 3) {
                    EXPECT_THAT(overlaps_of(layout_of(figure)), ElementsAre())
                        << style.width << ' ' << points << ' ' << panels;
                }
            }
}

// gnuplot would draw lines also outside a panel, into the next one.
TEST(FigureLayout, VerticalLinesStayWithinTheirPanel) {
    Figure figure{.panels = {panel_with(50)}};
    figure.panels[0].x_range = std::pair(0.2, 0.6);
    figure.panels[0].marks = {0.1, 0.2, 0.4125, 0.7125};
    const std::string script = figure_script(figure, "svg", "picture.svg");
    EXPECT_THAT(script, HasSubstr("\n0.4125 "));
    std::size_t lines = 0;
    for (std::size_t at = script.find("lw 0.5 lc"); at != std::string::npos; at = script.find("lw 0.5 lc", at + 1))
        ++lines;
    EXPECT_EQ(lines, 2U);
}

TEST(FigureLayout, HasTheRequestedSize) {
    Figure figure{"", 1, {panel_with(3)}};
    figure.style = {85, 60, 7, ""};
    const FigureLayout page = layout_of(figure);
    constexpr double points_per_mm = 72 / 25.4;
    EXPECT_NEAR(page.width, 85 * points_per_mm, 1e-9);
    EXPECT_NEAR(page.height, 60 * points_per_mm, 1);
    EXPECT_EQ(page.font, 7);
}

TEST(FigureLayout, NarrowPicturesHaveOneColumn) {
    Figure figure{"", 2, {panel_with(3), panel_with(3)}};
    figure.style.width = 170;
    EXPECT_EQ(layout_of(figure).panels[0].frame.low, layout_of(figure).panels[1].frame.low);
    figure.style.width = 85;
    EXPECT_GT(layout_of(figure).panels[0].frame.low, layout_of(figure).panels[1].frame.high);
}

TEST(FigureLayout, PanelsWithEqualSeriesShareALegend) {
    Figure figure{"", 2, {panel_with(3), panel_with(3)}};
    EXPECT_EQ(layout_of(figure).legend.size(), 1U);
    EXPECT_TRUE(layout_of(figure).panels[0].legend.empty());
    figure.panels[1].series[0].title = "held";
    EXPECT_TRUE(layout_of(figure).legend.empty());
    EXPECT_EQ(layout_of(figure).panels[1].legend.at(0).title, "held");
}

TEST(FigureLayout, LabelsOfAxesHaveUnitsAndPowersOfTen) {
    std::string texts;
    for (const RichText& text : texts_of(layout_of({"", 1, {panel_with(3)}})))
        texts += letters_of(text) + '\n';
    EXPECT_THAT(texts, HasSubstr("amplitude of the voltage of the source V0 (V)"));
    EXPECT_THAT(texts, HasSubstr("(10−6 m/s2)")); // as 10^-6, and a raised 2
}

TEST(FigureLayout, UnitsOnTheirOwnLineHaveParentheses) {
    Figure figure{"", 1, {panel_with(3)}};
    figure.panels[0].y_label = "velocity jump at the next";
    figure.panels[0].y_words = "";
    for (const double width : {60.0, 85.0, 120.0, 170.0}) {
        figure.style.width = width;
        for (const RichText& text : texts_of(layout_of(figure))) {
            const std::string letters = letters_of(text);
            EXPECT_EQ(std::count(letters.begin(), letters.end(), '('), std::count(letters.begin(), letters.end(), ')'))
                << letters << " at " << width;
        }
    }
}

TEST(FigureLayout, NamesAreSymbolsInTitlesLegendsAndLabels) {
    Figure figure{"Orbits at V0 = 3 V", 1, {panel_with(3)}};
    figure.symbols = {"V0"};
    figure.panels[0].title = "V0 up";
    figure.panels[0].series[0].title = "V0 = 3 V";
    figure.panels[0].y_label = "mean of V0";
    figure.panels[0].y_words = "";
    std::string all;
    for (const RichText& text : texts_of(layout_of(figure)))
        all += gnuplot_markup(text) + '\n';
    EXPECT_THAT(all, HasSubstr("Orbits at {/:Italic V}_{0} = 3 V"));
    EXPECT_THAT(all, HasSubstr("\n{/:Italic V}_{0} up"));
    EXPECT_THAT(all, HasSubstr("\n{/:Italic V}_{0} = 3 V"));
    EXPECT_THAT(all, HasSubstr("mean of {/:Italic V}_{0}"));
}

class ShippedPictures : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedPictures, NothingOverlapsAndNoNameIsRaw) {
    const TemporaryFolder folder;
    const Study study = quick(GetParam());
    copy_shipped_results(GetParam(), folder / "results.sqlite");
    ResultFile file(folder / "results.sqlite", ResultFile::Access::write);
    run_study(study, file, {});
    std::size_t labels = 0, crossed = 0;
    std::string places;
    for (StudyPicture picture : study.pictures)
        for (const FigureStyle& style : styles) {
            if (style.height > 0 && style.width < 100)
                continue; // too low for several panels
            picture.style = style;
            const Figure figure = make_picture(picture, file).figure;
            const FigureLayout page = layout_of(figure);
            const std::vector<std::string> on_lines = labels_on_lines(figure, page, labels);
            crossed += on_lines.size();
            for (const std::string& one : on_lines)
                places += picture.name + " at " + std::to_string(style.width) + " mm: " + one + '\n';
            if (picture.name == "fig-3-3" || picture.name == "fig-3-7") { // two orbits, to be compared
                EXPECT_EQ(page.panels.size(), 1U);
            }
            EXPECT_THAT(overlaps_of(page), ElementsAre()) << picture.name << " at " << style.width << " mm";
            EXPECT_THAT(raw_names(page, study, picture), ElementsAre()) << picture.name;
            std::string all;
            for (const NamedBox& box : boxes_of(page)) {
                EXPECT_EQ(box.name.find('_'), std::string::npos) << picture.name << " shows " << box.name;
                all += box.name + '\n';
            }
            EXPECT_EQ(std::count(all.begin(), all.end(), '('), std::count(all.begin(), all.end(), ')'))
                << picture.name << " shows " << all;
            // At most 24 entries, and two for line styles.
            for (const PanelLayout& panel : page.panels)
                EXPECT_LE(panel.legend.size(), 26U);
        }
    // Among a dozen close points there may be no free place that is nearer to the label's own point than to others.
    EXPECT_LE(40 * crossed, labels) << crossed << " of " << labels << ":\n" << places;
    RecordProperty("labels", static_cast<int>(labels));
    RecordProperty("crossed", static_cast<int>(crossed));
}

INSTANTIATE_TEST_SUITE_P(All, ShippedPictures, ::testing::ValuesIn(shipped_studies()), [](const auto& tested) {
    std::string name = tested.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

} // namespace graze::testing::figure_layout_test
