// Pictures of what an atlas has found: the plane of two parameters, and the diagram of one.

#include "graze/atlas/atlas_findings.hpp"
#include "graze/atlas/run_atlas.hpp"
#include "graze/base/text_file.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/study/stored_study.hpp"

#include "places.hpp"
#include "study/study_fixture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace graze::atlas_picture_test {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSubsetOf;
using testing::message_of;
using Style = FigureSeries::Style;

/// An atlas of the cubic map, whose curves are known, with a cusp at a = 1, b = 0.
const std::string cubic =
    "name = \"s\"\nmodel = \"cubic-map.toml\"\n[runs.map]\nkind = \"atlas\"\nsection = \"phase0\"\n"
    "multiple = 2\ncycles = 300\ndraws = 1\n";
const std::string plane = cubic + "vary = { b = { from = -0.5, to = 0.5, points = 11 }, a = [0.9, 1.1, 1.3, 1.5] }\n";
const std::string line = cubic + "set = { a = 1.3 }\nvary = { b = { from = -0.65, to = 0.65, points = 14 } }\n";
const std::string impacts = "name = \"s\"\nmodel = \"impact-oscillator\"\n[runs.map]\nkind = \"atlas\"\n";

std::vector<std::string> label_texts(const FigurePanel& panel) {
    std::vector<std::string> texts;
    for (const FigureLabel& label : panel.labels)
        texts.push_back(label.text);
    return texts;
}

/// Titles of the legend, in the order of the panel.
std::vector<std::string> titles(const FigurePanel& panel) {
    std::vector<std::string> found;
    for (const FigureSeries& series : panel.series)
        if (!series.title.empty())
            found.push_back(series.title);
    return found;
}

double area_of_cells(const FigurePanel& panel) {
    double area = 0;
    for (const FigureSeries& series : panel.series)
        for (const PlaneBox& cell : series.cells)
            area += (cell.right - cell.left) * (cell.high - cell.low);
    return area;
}

/// y where the lines of a panel pass an x.
std::vector<double> passes(const FigurePanel& panel, double x) {
    std::vector<double> found;
    for (const FigureSeries& series : panel.series)
        for (std::size_t i = 0; i + 1 < series.points.size() && !series.along.empty(); ++i) {
            const PlanePoint &one = series.points[i], &other = series.points[i + 1];
            if ((one.x < x) != (other.x < x))
                found.push_back(one.y + (x - one.x) / (other.x - one.x) * (other.y - one.y));
        }
    return found;
}

class AtlasPicture : public testing::StudyFixture {
protected:
    /// Carries out a study with all that its atlas explores.
    void explore(const std::string& text) const {
        folder_.write("cubic-map.toml",
                      read_text_file(std::string(testing::source_folder) + "/tests/atlas/truth/cubic-map.toml",
                                     "model file", 10000));
        Study study = read_study(folder_.write("s.toml", text));
        ResultFile file(path_, ResultFile::Access::write);
        const StudyRunner runner = [](const Study& whole, ResultFile& results, const RunnerOptions& options) {
            return run_study(whole, results, options);
        };
        testing::expect_complete(run_with_atlases(study, file, {}, runner));
    }
    ResultFile file() const { return ResultFile(path_, ResultFile::Access::read); }
    FigurePanel drawn(const StudyPicture& picture) const {
        const Figure figure = make_picture(picture, file()).figure;
        EXPECT_EQ(figure.panels.size(), 1U);
        return figure.panels.at(0);
    }
    StudyPicture picture() const { return default_picture(*file().find_run("map")); }
};

TEST_F(AtlasPicture, OfTwoParametersShowsRegionsCurvesAndPoints) {
    explore(plane);
    const AtlasFindings findings = atlas_findings(stored_study(file()), "map", file());
    const FigurePanel panel = drawn(picture());
    EXPECT_EQ(panel.x_range, std::pair(-0.5, 0.5));
    EXPECT_EQ(panel.y_range, std::pair(0.9, 1.5));
    EXPECT_NEAR(area_of_cells(panel), 0.6, 1e-12); // all of the box, once
    EXPECT_THAT(titles(panel), IsSubsetOf({"period 1, 0 contacts", "period 2, 0 contacts", "period 4, 0 contacts",
                                           "curves SN: fold", "curves PD: flip", "CP: cusp"}));
    EXPECT_THAT(titles(panel), AllOf(Contains("period 1, 0 contacts"), Contains("curves SN: fold"),
                                     Contains("curves PD: flip"), Contains("CP: cusp")));
    EXPECT_THAT(label_texts(panel), Contains("CP1"));
    for (const AtlasCurve& curve : findings.curves) {
        EXPECT_THAT(label_texts(panel), Contains(curve.name));
        const auto is_its_line = [&](const FigureSeries& series) {
            return series.run == curve.run && !series.points.empty() &&
                   series.style == (curve.type == PointType::fold ? Style::dashed : Style::dotted);
        };
        EXPECT_TRUE(std::ranges::any_of(panel.series, is_its_line)) << curve.name;
    }
    // Points of branches in the rows are no points of the plane.
    EXPECT_EQ(panel.labels.size(), findings.curves.size() + 1);
    EXPECT_THAT(panel.notes, IsEmpty());
}

// Two points at the end of a line, where a bound is a row, give it no kink.
TEST_F(AtlasPicture, LinesHaveCornersWherePointsCoincide) {
    explore(plane);
    std::size_t coincident = 0;
    for (const FigureSeries& series : drawn(picture()).series)
        for (std::size_t i = 1; i < series.along.size(); ++i)
            if (std::abs(series.along[i] - series.along[i - 1]) < 1e-13) {
                ++coincident;
                EXPECT_THAT(series.corners, AllOf(Contains(i - 1), Contains(i)));
            }
    EXPECT_GT(coincident, 0U);
}

// Symbols on the light regions of an atlas need no wide white disc, which would hide the curves.
TEST(AtlasRegions, LeaveRoomBesideSymbols) {
    const auto width_of_disc = [](std::size_t colour) {
        FigurePanel panel;
        panel.series.push_back({.style = Style::cells, .colour = colour, .cells = {{0, 1, 0, 1}}});
        panel.series.push_back({.style = Style::symbols, .points = {{0.5, 0.5}}});
        const std::string script = figure_script({.panels = {panel}}, "svg", "picture.svg");
        const std::size_t end = script.find(" lc rgb 'white'");
        EXPECT_NE(end, std::string::npos);
        return std::stod(script.substr(script.rfind("ps ", end) + 3));
    };
    EXPECT_NEAR(width_of_disc(3), 2 * width_of_disc(FigureSeries::pale + 3), 0.01);
}

TEST_F(AtlasPicture, HalvesOfARegionShowBothDirections) {
    testing::expect_complete(run(impacts + "vary = { omega = [2.66, 2.675, 2.69], e = [0.79, 0.8] }\n"));
    const FigurePanel both = drawn(picture());
    EXPECT_THAT(both.notes, Contains(HasSubstr("lower half, as omega rises; upper half, as omega falls")));
    EXPECT_NEAR(area_of_cells(both), 0.03 * 0.01, 1e-12);
    StudyPicture up = picture();
    up.directions = {"up"};
    EXPECT_THAT(drawn(up).notes, ElementsAre("the atlas is not finished"));
    EXPECT_NEAR(area_of_cells(drawn(up)), 0.03 * 0.01, 1e-12);
}

// Orbits are drawn where they pass the section, as the motions that settle on them are sampled.
TEST_F(AtlasPicture, OfOneParameterShowsBranchesThroughTheSamples) {
    explore(line);
    const FigurePanel panel = drawn(picture());
    EXPECT_EQ(panel.y_label, "x");
    EXPECT_EQ(panel.x_range, std::pair(-0.65, 0.65));
    std::size_t samples = 0;
    for (const FigureSeries& series : panel.series)
        for (const PlanePoint& sample : series.points)
            if (series.style == Style::dots && series.title.empty() && std::abs(sample.x) < 0.6) {
                ++samples;
                const std::vector<double> lines = passes(panel, sample.x);
                EXPECT_TRUE(std::ranges::any_of(lines, [&](double y) { return std::abs(y - sample.y) < 0.01; }))
                    << sample.x << ' ' << sample.y;
            }
    EXPECT_GT(samples, 20U);
    EXPECT_EQ(passes(panel, 0.02).size(), 3U); // between both folds
    EXPECT_EQ(passes(panel, 0.5).size(), 3U);  // period 1, and both passages of period 2
    EXPECT_THAT(titles(panel), AllOf(Contains("stable"), Contains("unstable"), Contains("PD: flip")));
    const std::vector<std::string> all = titles(panel);
    EXPECT_EQ(std::set(all.begin(), all.end()).size(), all.size());
    EXPECT_THAT(label_texts(panel), AllOf(Contains("SN1"), Contains("SN2"), Contains("PD1")));
}

TEST_F(AtlasPicture, OfOneParameterCanShowAMonitor) {
    explore(line);
    StudyPicture greatest = picture();
    greatest.y = {"max_x"};
    const FigurePanel panel = drawn(greatest);
    EXPECT_EQ(panel.y_label, "max_x");
    EXPECT_EQ(passes(panel, 0.5).size(), 2U);
    for (const FigureSeries& series : panel.series)
        EXPECT_NE(series.style, Style::dots); // motions have no greatest values
    greatest.y = {"nothing"};
    EXPECT_THAT(message_of([&] { drawn(greatest); }), HasSubstr("no monitor or parameter 'nothing'"));
}

// Where there are too many points, the stable orbits' are marked.
TEST_F(AtlasPicture, OfManyPointsTellsHowManyAreNotMarked) {
    explore(impacts + "vary = { omega = { from = 2.66, to = 2.83, points = 10 } }\ncontacts = 3\nbranches = 16\n"
                      "draws = 0\ncycles = 200\n");
    const FigurePanel panel = drawn(picture());
    ASSERT_THAT(panel.notes, Contains(HasSubstr("points at which no stable orbits begin or end")));
    StudyPicture grazings = picture();
    grazings.points = {"GR"};
    EXPECT_THAT(label_texts(drawn(grazings)), Contains("GR1"));
    EXPECT_THAT(label_texts(panel), ::testing::Not(Contains("GR1")));
}

TEST_F(AtlasPicture, ShowsWhatThereIsOfAnUnfinishedOne) {
    std::size_t left = 5;
    RunnerOptions options;
    options.interrupted = [&] { return left == 0; };
    options.progress = [&](const StudyProgress&) { left -= left > 0 ? 1 : 0; };
    run(impacts + "vary = { omega = [2.7, 2.75, 2.8, 2.85], e = [0.7, 0.8] }\ncycles = 60\n", options);
    const FigurePanel panel = drawn(picture());
    EXPECT_THAT(panel.notes, Contains("the atlas is not finished"));
    EXPECT_GT(area_of_cells(panel), 0);
    EXPECT_LT(area_of_cells(panel), 0.15 * 0.1);
}

TEST_F(AtlasPicture, IsEmptyBeforeTheFirstMotion) {
    for (const char* vary : {"{ omega = [2.7, 2.8], e = [0.7, 0.8] }", "{ omega = [2.7, 2.8] }"}) {
        RunnerOptions options;
        options.interrupted = [] { return true; };
        run(impacts + "vary = " + vary + "\n", options);
        const FigurePanel panel = drawn(picture());
        EXPECT_EQ(panel.x_range, std::pair(2.7, 2.8));
        EXPECT_THAT(titles(panel), IsEmpty());
    }
}

TEST_F(AtlasPicture, RefusesOtherAxes) {
    testing::expect_complete(run(impacts + "vary = { omega = [2.7, 2.8], e = [0.7, 0.8] }\ncycles = 60\n"));
    StudyPicture other = picture();
    other.x = "e";
    EXPECT_THAT(message_of([&] { drawn(other); }), HasSubstr("x axis of an atlas is its first parameter, 'omega'"));
    other.x = "omega";
    other.y = {"x"};
    EXPECT_THAT(message_of([&] { drawn(other); }), HasSubstr("y axis of an atlas is its second parameter, 'e'"));
    other.y = {"e"};
    EXPECT_THAT(message_of([&] { drawn(other); }), IsEmpty());
}

TEST_F(AtlasPicture, StandsForTheRunsThatItHasMade) {
    explore(line);
    EXPECT_TRUE(has_own_picture(*file().find_run("map"), file()));
    EXPECT_FALSE(has_own_picture(*file().find_run("map.branch1"), file()));
}

// The samples of an atlas can be drawn as those of a sweep, with the values at which something changes.
TEST_F(AtlasPicture, IsADiagramLikeThatOfASweep) {
    const std::string keys = "direction = \"both\"\nvary = { omega = { from = 2.6, to = 2.9, points = 25 } }\n";
    testing::expect_complete(run(impacts + keys + "[runs.plain]\nkind = \"sweep\"\n" + keys));
    StudyPicture diagram = picture();
    EXPECT_EQ(diagram.kind, "atlas");
    diagram.kind = "bifurcation";
    const Figure figure = make_picture(diagram, file()).figure;
    const Figure of_sweep = make_picture(default_picture(*file().find_run("plain")), file()).figure;
    ASSERT_EQ(figure.panels.size(), of_sweep.panels.size());
    ASSERT_FALSE(figure.panels.empty());
    EXPECT_FALSE(figure.panels.front().marks.empty());
    for (std::size_t p = 0; p < figure.panels.size(); ++p) {
        EXPECT_EQ(figure.panels[p].marks, of_sweep.panels[p].marks);
        ASSERT_EQ(figure.panels[p].series.size(), of_sweep.panels[p].series.size());
        for (std::size_t s = 0; s < figure.panels[p].series.size(); ++s)
            EXPECT_EQ(figure.panels[p].series[s].points.size(), of_sweep.panels[p].series[s].points.size());
    }
}

} // namespace graze::atlas_picture_test
