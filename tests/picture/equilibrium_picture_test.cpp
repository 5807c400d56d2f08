// Pictures of equilibria: points, and branches beside those of cycles, whose periods they do not have.

#include "graze/picture/result_picture.hpp"
#include "graze/results/orbit_motion.hpp"
#include "graze/study/runner.hpp"

#include "base/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <set>

namespace graze::equilibrium_picture_test {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

/// A double well with damping: equilibria at x = -1, 0 and 1, of which the middle one is a saddle.
const char* const well = R"(name = "well"
[parameters]
h = 0
[states]
x = 0.9
v = 0
[modes.free]
rates = { x = "v", v = "x - x^3 + h - 0.2*v" }
)";

/// The Brusselator, from whose equilibrium (a, b/a) cycles begin at b = 1 + a^2.
const char* const brusselator = R"(name = "brusselator"
[parameters]
a = 1
b = 1
[states]
x = 1
y = 1
[modes.free]
rates = { x = "1 - (b + 1)*x + a*x^2*y", y = "b*x - a*x^2*y" }
)";

const char* const text = R"(name = "s"
[runs.wells]
model = "./well.toml"
kind = "equilibrium"
within = { x = [-3, 3], v = [-1, 1] }
[runs.side]
model = "./well.toml"
kind = "equilibrium"
[runs.along]
model = "./well.toml"
kind = "continue"
start = { run = "side" }
along = { h = [0, 1] }
[runs.rest]
model = "./brusselator.toml"
kind = "continue"
signature = "equilibrium"
along = { b = [0.5, 4] }
[runs.cycles]
model = "./brusselator.toml"
kind = "continue"
start = { run = "rest", point = "HB1" }
along = { b = [0.5, 4] }
)";

class EquilibriumPicture : public ::testing::Test {
protected:
    static const ResultFile& file() {
        static const testing::TemporaryFolder folder;
        static const std::unique_ptr<ResultFile> computed = [] {
            std::ofstream(folder / "well.toml") << well;
            std::ofstream(folder / "brusselator.toml") << brusselator;
            auto results = std::make_unique<ResultFile>(folder / "results.sqlite", ResultFile::Access::write);
            for (const RunReport& report : run_study(parse_study(text, folder / "s.toml"), *results, {}))
                EXPECT_EQ(report.problem, "") << report.name;
            return results;
        }();
        return *computed;
    }
    static Figure figure(std::vector<std::string> runs, std::string kind = "", std::vector<std::string> points = {}) {
        StudyPicture picture;
        picture.runs = std::move(runs);
        picture.kind = std::move(kind);
        picture.points = std::move(points);
        return make_picture(picture, file()).figure;
    }
    /// The abscissae of the points that have an entry in the legend, rounded.
    static std::vector<double> at(const FigurePanel& panel, const std::string& title) {
        std::vector<double> found;
        for (const FigureSeries& series : panel.series)
            if (series.title == title)
                for (const PlanePoint& point : series.points)
                    found.push_back(std::round(1e6 * point.x) / 1e6 + 0.0);
        return found;
    }
};

TEST_F(EquilibriumPicture, OfABoxShowsEachInThePlaneOfStates) {
    const Figure shown = figure({"wells"});
    ASSERT_EQ(shown.panels.size(), 1U);
    const FigurePanel& panel = shown.panels[0];
    EXPECT_EQ(panel.x_label, "x");
    EXPECT_EQ(panel.y_label, "v");
    EXPECT_THAT(at(panel, "stable equilibrium"), UnorderedElementsAre(-1, 1));
    EXPECT_THAT(at(panel, "unstable equilibrium"), ElementsAre(0));
    std::set<int> symbols;
    for (const FigureSeries& series : panel.series) {
        EXPECT_EQ(series.style, FigureSeries::Style::symbols);
        EXPECT_EQ(series.points.size(), 1U);
        EXPECT_EQ(series.colour, panel.series[0].colour);
        symbols.insert(series.symbol);
    }
    EXPECT_EQ(symbols.size(), 2U);
}

TEST_F(EquilibriumPicture, OfSeveralRunsNamesThem) {
    const Figure shown = figure({"wells", "side"});
    ASSERT_EQ(shown.panels.size(), 1U);
    EXPECT_THAT(at(shown.panels[0], "wells, stable equilibrium"), UnorderedElementsAre(-1, 1));
    EXPECT_THAT(at(shown.panels[0], "side, stable equilibrium"), ElementsAre(1));
}

TEST_F(EquilibriumPicture, OfAMotionIsOnePoint) {
    for (const char* kind : {"portrait", "history"})
        for (const FigurePanel& panel : figure({"rest"}, kind, {"HB1"}).panels) {
            ASSERT_EQ(panel.series.size(), 1U) << kind;
            EXPECT_EQ(panel.series[0].points.size(), 1U) << kind;
            EXPECT_EQ(panel.series[0].style, FigureSeries::Style::symbols) << kind;
        }
    const Model model = stored_model(*file().find_run("rest"));
    const Orbit orbit = file().orbit("rest", "HB1")->point.solution.orbit;
    const std::vector<SegmentMotion> motion = orbit_motion(model, orbit, 100);
    ASSERT_EQ(motion.size(), 1U);
    EXPECT_THAT(motion[0].times, ElementsAre(0));
    EXPECT_EQ(motion[0].end, "equilibrium");
}

TEST_F(EquilibriumPicture, OfBranchesHasPeriodsOnlyOfCycles) {
    const Figure shown = figure({"rest", "cycles"});
    std::set<std::string> values;
    for (const FigurePanel& panel : shown.panels) {
        values.insert(panel.y_label);
        for (const FigureSeries& series : panel.series) {
            if (series.only_in_legend || series.run != "rest")
                continue;
            for (const PlanePoint& point : series.points)
                EXPECT_EQ(std::isfinite(point.y), panel.y_label != "period");
        }
    }
    EXPECT_TRUE(values.contains("period"));
}

TEST_F(EquilibriumPicture, OfABoxOverAParameterJoinsNothing) {
    const Figure shown = figure({"along", "wells"}, "branch");
    std::size_t points = 0;
    for (const FigureSeries& series : shown.panels.at(0).series)
        if (series.run == "wells") {
            EXPECT_EQ(series.style, FigureSeries::Style::circles);
            points += series.points.size();
        }
    EXPECT_EQ(points, 3U);
}

} // namespace graze::equilibrium_picture_test
