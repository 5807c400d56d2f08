#include "graze/picture/figure_script.hpp"
#include "graze/picture/result_picture.hpp"
#include "program/process.hpp"
#include "program/table.hpp"
#include "run_graze.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>
#include <numbers>
#include <tuple>

namespace graze::testing::plot_results_test {

using ::testing::HasSubstr;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr const char* model_text = "[parameters]\na = 1\nb = 0\n[states]\nx = 1\ny = 0\n[modes.only.rates]\nx = \"y\"\n"
                                   "y = \"-a^2*x\"\n";

/// Results written by hand, so that the contents of pictures are known.
class PlotResults : public ::testing::Test {
protected:
    PlotResults() : path(folder / "results.sqlite") {}

    static RunRecord run_of(const std::string& kind, std::vector<ResultColumn> coordinates) {
        RunRecord run;
        run.name = run.kind = kind;
        run.model_name = "hand-made";
        run.model = model_text;
        run.settings = "{}";
        run.fingerprint = "f";
        run.version = "test";
        run.coordinates = std::move(coordinates);
        run.states = {{"x", ""}, {"y", ""}};
        run.values = {{"x", "m"}, {"y", "m/s"}};
        run.samplings = {"first", "second"};
        run.modes = {"only"};
        run.directions = kind == "sweep" ? std::vector<std::string>{"up", "down"} : std::vector<std::string>{""};
        return run;
    }
    static PointRecord point_of(std::size_t number, std::vector<double> coordinates, Label label) {
        PointRecord point;
        point.number = number;
        point.coordinates = std::move(coordinates);
        point.result.label = label;
        point.result.state = {1, 0};
        point.result.samples.width = 2;
        return point;
    }
    static void add(PointRecord& point, std::size_t sampling, double time, double x, double y) {
        SampleSet& samples = point.result.samples;
        samples.samplings.push_back(sampling);
        samples.times.push_back(time);
        samples.values.insert(samples.values.end(), {x, y});
    }
    static StudyPicture picture_of(const std::string& kind, const std::string& run) {
        StudyPicture picture;
        picture.kind = kind;
        picture.name = "picture";
        picture.runs = {run};
        return picture;
    }
    /// Writes a sweep with period 1 up to a = 49 and period 2 above; on the way down period 2 lasts to a = 47.
    void write_sweep() const {
        ResultFile file(path, ResultFile::Access::write);
        const RunRecord run = run_of("sweep", {{"a", "V"}});
        file.begin_run(run);
        for (std::size_t number = 0; number < 200; ++number) {
            const std::size_t direction = number / 100;
            const std::size_t a = direction == 0 ? number : 199 - number;
            PointRecord point = point_of(number, {static_cast<double>(a)}, Label::periodic);
            point.direction = direction;
            point.result.period = a < (direction == 0 ? 50 : 47) ? 1 : 2;
            point.result.duration = 2 * std::numbers::pi;
            for (std::size_t i = 0; i < point.result.period; ++i) {
                add(point, 0, static_cast<double>(i), static_cast<double>(a + i), 7);
                add(point, 1, static_cast<double>(i) + 0.5, -static_cast<double>(a + i), 8);
            }
            file.add_point(run.name, point);
        }
        file.complete_run(run.name);
    }

    Folder folder;
    std::string path;
};

TEST_F(PlotResults, ShowsBothDirectionsOfASweepWithChangesOfPeriod) {
    write_sweep();
    const ResultFile file(path, ResultFile::Access::read);
    const Figure figure = make_picture(picture_of("bifurcation", "sweep"), file).figure;
    EXPECT_EQ(figure.columns, 2U);
    ASSERT_EQ(figure.panels.size(), 4U);
    EXPECT_EQ(figure.panels[0].y_label, "x");
    EXPECT_EQ(figure.panels[1].y_unit, "m/s");
    EXPECT_EQ(figure.panels[2].x_unit, "V");
    EXPECT_THAT(figure.panels[0].title, HasSubstr("up"));
    EXPECT_THAT(figure.panels[3].title, HasSubstr("down"));
    ASSERT_EQ(figure.panels[0].series.size(), 2U);
    EXPECT_EQ(figure.panels[0].series[0].points.size(), 50U + 2 * 50U);
    EXPECT_EQ(figure.panels[2].series[1].points.size(), 47U + 2 * 53U);
    EXPECT_EQ(figure.panels[0].marks, std::vector<double>{49.5});
    EXPECT_EQ(figure.panels[2].marks, std::vector<double>{46.5});
}

TEST_F(PlotResults, ShowsOnlyChosenValuesAndDirections) {
    write_sweep();
    const ResultFile file(path, ResultFile::Access::read);
    StudyPicture picture = picture_of("bifurcation", "sweep");
    picture.y = {"y"};
    picture.directions = {"down"};
    picture.samplings = {"second"};
    const Figure figure = make_picture(picture, file).figure;
    ASSERT_EQ(figure.panels.size(), 1U);
    ASSERT_EQ(figure.panels[0].series.size(), 1U);
    for (const PlanePoint& point : figure.panels[0].series[0].points)
        EXPECT_EQ(point.y, 8);
    picture.y = {"z"};
    EXPECT_THROW(make_picture(picture, file), InputError);
}

TEST_F(PlotResults, DistinguishesTheAttractorsOfABasin) {
    {
        ResultFile file(path, ResultFile::Access::write);
        const RunRecord run = run_of("basin", {{"a", ""}, {"b", ""}});
        file.begin_run(run);
        for (std::size_t number = 0; number < 30; ++number) {
            const std::size_t kind = number % 3;
            PointRecord point = point_of(number, {static_cast<double>(number % 6), static_cast<double>(number / 6)},
                                         kind == 2 ? Label::escaped : Label::periodic);
            point.result.period = kind == 2 ? 0 : 2;
            // Two orbits of period 2; the samples of each begin at either of its two points.
            const bool swapped = number % 2 == 0;
            if (kind < 2)
                for (std::size_t i = 0; i < 2; ++i)
                    add(point, 0, static_cast<double>(i), (swapped ? i == 0 : i == 1) ? 1.0 : 2.0,
                        kind == 0 ? 0.25 : 0.75);
            file.add_point(run.name, point);
        }
        file.complete_run(run.name);
    }
    const ResultFile file(path, ResultFile::Access::read);
    const ResultPicture made = make_picture(picture_of("basin", "basin"), file);
    ASSERT_EQ(made.figure.panels.size(), 1U);
    ASSERT_EQ(made.figure.panels[0].series.size(), 3U);
    for (const FigureSeries& series : made.figure.panels[0].series)
        EXPECT_EQ(series.cells.size(), 10U) << series.title; // no two adjacent cells are equal
    EXPECT_EQ(made.table.rows(), 3U);
    const auto named = [&](const std::string& name) {
        return run_graze({"plot", path, "--kind", "basin", "--output", folder / "basin.svg", "--name", name});
    };
    EXPECT_EQ(named("period 2=twice").code, 0);
    EXPECT_THAT(named("period 3=thrice").err, HasSubstr("'period 3': the picture shows nothing of that name; did you"));
}

TEST_F(PlotResults, MapsAttractorsOverTwoParametersInBothDirections) {
    {
        ResultFile file(path, ResultFile::Access::write);
        const RunRecord run = run_of("sweep", {{"a", "V"}, {"b", "Hz"}});
        file.begin_run(run);
        for (std::size_t number = 0; number < 24; ++number) {
            const std::size_t direction = number / 12, a = number % 4, b = number % 12 / 4;
            const bool lost = direction == 1 && a == 1;
            PointRecord point = point_of(number, {static_cast<double>(a), 10.0 + static_cast<double>(b)},
                                         lost ? Label::escaped : Label::periodic);
            point.direction = direction;
            point.result.period = lost ? 0 : a < 2 ? 1 : 2;
            if (!lost) // all orbits differ, which a map does not show
                add(point, 0, 0, static_cast<double>(number), 0);
            file.add_point(run.name, point);
        }
        file.complete_run(run.name);
    }
    const ResultFile file(path, ResultFile::Access::read);
    const ResultPicture made = make_picture(picture_of("map", "sweep"), file);
    ASSERT_EQ(made.figure.panels.size(), 2U);
    const FigurePanel &up = made.figure.panels[0], &down = made.figure.panels[1];
    EXPECT_EQ(up.title, "(a) a up");
    EXPECT_EQ(down.title, "(b) a down");
    EXPECT_EQ(up.x_unit, "V");
    EXPECT_EQ(up.y_unit, "Hz");
    ASSERT_EQ(up.series.size(), 2U);
    EXPECT_EQ(up.series[0].title, "period 1 (6)");
    EXPECT_EQ(up.series[1].title, "period 2 (6)");
    ASSERT_EQ(up.series[0].cells.size(), 6U);
    EXPECT_EQ(up.series[0].numbers, (std::vector<std::size_t>{0, 1, 4, 5, 8, 9}));
    EXPECT_EQ(up.series[0].cells[0].left, -0.5);
    EXPECT_EQ(up.series[0].cells[1].right, 1.5);
    EXPECT_EQ(up.series[0].cells[0].low, 9.5);
    EXPECT_EQ(up.series[0].cells[0].high, 10.5);
    EXPECT_EQ(up.series[1].cells[5].right, 3.5);
    EXPECT_EQ(up.series[1].cells[5].high, 12.5);
    ASSERT_EQ(down.series.size(), 3U);
    EXPECT_EQ(down.series[0].title, "period 1 (3)");
    EXPECT_EQ(down.series[1].title, "escaped (3)");
    EXPECT_EQ(down.series[1].colour, FigureSeries::grey);
    EXPECT_EQ(down.series[2].title, "period 2 (6)");
    EXPECT_EQ(down.series[2].colour, 1U);
    EXPECT_EQ(made.table.rows(), 5U);
    EXPECT_TRUE(up.labels.empty());
}

TEST_F(PlotResults, MarksAttractorsInTheirBasins) {
    {
        ResultFile file(path, ResultFile::Access::write);
        const RunRecord run = run_of("basin", {{"x", "m"}, {"y", "m/s"}});
        file.begin_run(run);
        for (std::size_t number = 0; number < 20; ++number) {
            const std::size_t kind = number % 5 < 2 ? 0 : number % 5 < 4 ? 1 : 2;
            PointRecord point = point_of(number, {static_cast<double>(number % 5), static_cast<double>(number / 5)},
                                         kind == 0   ? Label::periodic
                                         : kind == 1 ? Label::equilibrium
                                                     : Label::escaped);
            point.result.period = kind == 0 ? 2 : 0;
            if (kind == 0) {
                add(point, 0, 0, 1, 0.25);
                add(point, 0, 1, 2, 0.5);
                add(point, 1, 1, 4, 4); // belongs to the other sampling, which is not drawn
            } else {
                add(point, 0, 0, 3, 0.75);
            }
            file.add_point(run.name, point);
        }
        file.complete_run(run.name);
    }
    const ResultFile file(path, ResultFile::Access::read);
    const ResultPicture made = make_picture(picture_of("basin", "basin"), file);
    ASSERT_EQ(made.figure.panels.size(), 1U);
    const FigurePanel& panel = made.figure.panels[0];
    std::vector<std::tuple<double, double, std::string>> labels;
    for (const FigureLabel& label : panel.labels)
        labels.emplace_back(label.at.x, label.at.y, label.text);
    EXPECT_THAT(labels, ::testing::ElementsAre(std::tuple(1, 0.25, "1"), std::tuple(2, 0.5, "1"),
                                               std::tuple(3, 0.75, "2"))); // escaped motions have no mark
    std::size_t marks = 0;
    for (const FigureSeries& series : panel.series)
        if (series.style == FigureSeries::Style::symbols)
            marks += series.points.size();
    EXPECT_EQ(marks, 3U);
    EXPECT_EQ(made.table.rows(), 3U);
}

TEST_F(PlotResults, FindsTheFrequencyOfAWaveInPercentOfTheMean) {
    {
        ResultFile file(path, ResultFile::Access::write);
        const RunRecord run = run_of("simulate", {});
        file.begin_run(run);
        PointRecord point = point_of(0, {}, Label::ended);
        for (int i = 0; i < 64; ++i)
            add(point, 0, 0.125 * i, -4 + std::sin(2 * std::numbers::pi * 5 * i / 64), 0);
        file.add_point(run.name, point);
        file.complete_run(run.name);
    }
    const ResultFile file(path, ResultFile::Access::read);
    StudyPicture picture = picture_of("spectrum", "simulate");
    picture.samplings = {"first"};
    const Figure figure = make_picture(picture, file).figure;
    ASSERT_EQ(figure.panels.size(), 1U);
    const std::vector<PlanePoint>& points = figure.panels[0].series.at(0).points;
    ASSERT_EQ(points.size(), 32U);
    for (std::size_t k = 1; k <= points.size(); ++k) {
        EXPECT_NEAR(points[k - 1].x, static_cast<double>(k) * 8 / 64, 8 * eps);
        EXPECT_NEAR(points[k - 1].y, k == 5 ? 25 : 0, 100 * 64 * 8 * eps) << k;
    }
}

TEST_F(PlotResults, FitsPowersToSuccessiveValues) {
    {
        ResultFile file(path, ResultFile::Access::write);
        const RunRecord run = run_of("simulate", {{"a", ""}});
        file.begin_run(run);
        for (std::size_t number = 0; number < 20; ++number) {
            const double factor = number % 2 == 0 ? 10 : 100;
            PointRecord point = point_of(number, {factor}, Label::ended);
            double value = 1e-6 * static_cast<double>(number + 1);
            for (int i = 0; i < 3; ++i, value = factor * std::sqrt(value))
                add(point, 0, i, value, 0);
            file.add_point(run.name, point);
        }
        file.complete_run(run.name);
    }
    const ResultFile file(path, ResultFile::Access::read);
    StudyPicture picture = picture_of("regression", "simulate");
    picture.y = {"x"};
    picture.group = "a";
    picture.successive = picture.logarithmic_x = picture.logarithmic_y = true;
    const ResultPicture made = make_picture(picture, file);
    std::ostringstream text;
    write_table(text, made.table, TableFormat::csv, 17, {});
    const Csv table(text.str());
    ASSERT_EQ(table.rows.size(), 2U);
    for (std::size_t group = 0; group < 2; ++group) {
        EXPECT_NEAR(table.number(group, "slope"), 0.5, 1e3 * eps);
        EXPECT_NEAR(table.number(group, "intercept"), group == 0 ? 1 : 2, 1e3 * eps);
        EXPECT_NEAR(table.number(group, "slope_error"), 0, 1e3 * eps);
        EXPECT_EQ(table.number(group, "points"), 20);
    }
}

// The orbit is computed again from its state: x = cos t, y = -sin t.
TEST_F(PlotResults, RecomputesAnOrbitBetweenItsSamples) {
    write_sweep();
    const ResultFile file(path, ResultFile::Access::read);
    StudyPicture picture = picture_of("portrait", "sweep");
    picture.at = {{"a", 1}};
    picture.x = "x";
    picture.y = {"y"};
    const Figure figure = make_picture(picture, file).figure;
    ASSERT_EQ(figure.panels.size(), 1U);
    const FigureSeries& curve = figure.panels[0].series.at(0);
    EXPECT_EQ(curve.style, FigureSeries::Style::line);
    EXPECT_GT(curve.points.size(), 50U);
    for (const PlanePoint& point : curve.points)
        EXPECT_NEAR(point.x * point.x + point.y * point.y, 1, 1e-10);
    EXPECT_NEAR(curve.points.back().x, 1, 1e-10);
    EXPECT_NEAR(curve.points.back().y, 0, 1e-10);
}

TEST_F(PlotResults, ScatterDrawsExpressionsOfPoints) {
    write_sweep();
    const ResultFile file(path, ResultFile::Access::read);
    StudyPicture picture = picture_of("scatter", "sweep");
    picture.x = "a - 50";
    picture.y = {"period"};
    const Figure figure = make_picture(picture, file).figure;
    ASSERT_EQ(figure.panels.size(), 1U);
    const std::vector<PlanePoint>& points = figure.panels[0].series.at(0).points;
    ASSERT_EQ(points.size(), 200U);
    EXPECT_EQ(points[0].x, -50);
    EXPECT_EQ(points[99].y, 2);
}

TEST_F(PlotResults, WritesEveryFormat) {
    if (!find_program("gnuplot"))
        GTEST_SKIP() << "no gnuplot";
    write_sweep();
    for (const std::string ending : {"svg", "png", "pdf"}) {
        const std::string picture = folder / ("picture." + ending);
        const std::string run = done({"plot", path, "--output", picture, "--data", folder / "picture.gp"});
        EXPECT_EQ(run, picture + "\n");
        EXPECT_GT(contents(picture).size(), 3000U);
        EXPECT_LT(contents(picture).size(), 2000000U);
    }
    EXPECT_THAT(contents(folder / "picture.gp"), HasSubstr("multiplot"));
}

// The output for LaTeX, checked without LaTeX: texts as its commands, and the lines in a PDF beside it.
TEST_F(PlotResults, WritesTextForLatexAndItsLinesAsPdf) {
    if (!find_program("gnuplot"))
        GTEST_SKIP() << "no gnuplot";
    write_sweep();
    done({"plot", path, "--y", "x", "--x-label", "50% of $V_0$", "--output", folder / "picture.tex", "--data",
          folder / "picture.gp", "--title", "where a = 1"});
    const std::string text = contents(folder / "picture.tex"), commands = contents(folder / "picture.gp");
    EXPECT_THAT(commands, HasSubstr("set terminal cairolatex pdf input size"));
    EXPECT_THAT(commands, HasSubstr("50\\\\% of \\\\$V\\\\_0\\\\$"));
    EXPECT_THAT(text, HasSubstr("\\fontsize{9}{10.8}\\selectfont")); // the font size for a picture of 170 mm
    EXPECT_THAT(text, HasSubstr("50\\% of \\$V\\_0\\$"));
    EXPECT_THAT(text, HasSubstr("\\fontsize{9.9}{11.88}\\selectfont{}where \\textit{a} = 1")); // its title
    EXPECT_THAT(text, HasSubstr("\\fontsize{8.28}{9.936}\\selectfont{}first"));                // its legend
    EXPECT_THAT(text, HasSubstr("\\includegraphics"));
    EXPECT_THAT(text, HasSubstr("{picture}"));
    EXPECT_EQ(text.find(folder / ""), std::string::npos); // no path of this machine
    EXPECT_TRUE(contents(folder / "picture.pdf").starts_with("%PDF"));
    EXPECT_EQ(folder.files(), 4U + (std::filesystem::exists(path + ".lock") ? 1U : 0U));
}

TEST_F(PlotResults, ReportsUnknownNames) {
    write_sweep();
    const auto said = [this](const std::vector<std::string>& options) {
        std::vector<std::string> words{"plot", path, "--output", folder / "no.png"};
        words.insert(words.end(), options.begin(), options.end());
        const Printed run = run_graze(words);
        EXPECT_NE(run.code, 0);
        return run.err;
    };
    EXPECT_THAT(said({"--run", "swep"}), HasSubstr("swep"));
    EXPECT_THAT(said({"--y", "z"}), HasSubstr("'z'"));
    EXPECT_THAT(said({"--sample", "third"}), HasSubstr("third"));
    EXPECT_THAT(said({"--direction", "sideways"}), HasSubstr("sideways"));
    EXPECT_THAT(said({"--kind", "pie"}), HasSubstr("pie"));
    EXPECT_THAT(said({"--kind", "basin"}), HasSubstr("fewer than two"));
    EXPECT_THAT(said({"--x-range", "3"}), HasSubstr("A:B"));
    EXPECT_THAT(said({"--x-range", "3:2"}), HasSubstr("empty"));
    EXPECT_THAT(said({"--at", "a"}), HasSubstr("NAME=VALUE"));
    EXPECT_THAT(said({"--name", "nothing=A"}), HasSubstr("the picture shows nothing of that name; known are: "));
    EXPECT_THAT(said({"--name", "nothing=A"}), HasSubstr("first, second, sweep"));
    EXPECT_THAT(said({"--name", "swepe=A"}), HasSubstr("did you mean 'sweep'?"));
    EXPECT_THAT(said({"--name", "sweep=A", "sweep=B"}), HasSubstr("'sweep' is given twice; leave one of them out"));
    EXPECT_FALSE(std::filesystem::exists(folder / "no.png"));
}

} // namespace graze::testing::plot_results_test
