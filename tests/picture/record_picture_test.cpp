#include "graze/base/input_error.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/runner.hpp"

#include "base/temporary_folder.hpp"
#include "study/wave_records.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graze::record_picture_test {

using testing::waves;

constexpr double frequency = testing::wave_frequency;
constexpr const char* head = testing::record_head;

class RecordPictures : public ::testing::Test {
protected:
    testing::TemporaryFolder folder_;
};

TEST_F(RecordPictures, DiagramsHaveAPanelForEachValueAndDirection) {
    for (int i = 1; i <= 3; ++i) {
        folder_.write(fmt::format("u{}.csv", i), waves(i, 1));
        folder_.write(fmt::format("d{}.csv", i), waves(4 - i, 1, 0.1));
    }
    const Study study = read_study(folder_.write(
        "s.toml", std::string(head) +
                      "files = { up = \"u*.csv\", down = [\"d1.csv\", \"d2.csv\", \"d3.csv\"] }\nreference = \"V\"\n"));
    ResultFile file(folder_ / "results.sqlite", ResultFile::Access::write);
    run_study(study, file, {});
    const Figure figure = make_picture(default_picture(*file.find_run("r")), file).figure;
    ASSERT_EQ(figure.panels.size(), 4); // two values, two directions; rows of records are not drawn
    for (const FigurePanel& panel : figure.panels)
        EXPECT_EQ(panel.series.size(), 1);
    EXPECT_EQ(figure.panels[0].x_unit, "V");
}

TEST_F(RecordPictures, MeasuredPointsAreDrawnOverComputedOnes) {
    for (int i = 1; i <= 2; ++i)
        folder_.write(fmt::format("{}.csv", i), waves(i, 1));
    folder_.write("m.toml", R"(name = "m"
parameters = { amplitude = 1 }
[states]
q = { initial = "amplitude" }
theta = { initial = 0, period = 1 }
[modes.a]
rates = { q = 0, theta = 1 }
[sections.turn]
state = "theta"
value = 0
)");
    const Study study = read_study(folder_.write("s.toml", std::string(head) + R"(files = "*.csv"
reference = "V"
[runs.computed]
kind = "simulate"
model = "./m.toml"
vary = { amplitude = [1.2, 1.4, 1.6] }
periods = 3
values = ["q"]
[pictures.both]
kind = "bifurcation"
run = "computed"
over = "r"
[pictures.nothing]
kind = "bifurcation"
run = "r"
y = ["V"]
over = "computed"
[pictures.wrong]
kind = "scatter"
run = "computed"
)"));
    ResultFile file(folder_ / "results.sqlite", ResultFile::Access::write);
    run_study(study, file, {});
    const Figure figure = make_picture(study.pictures[0], file).figure;
    ASSERT_EQ(figure.panels.size(), 1);
    const FigureSeries& measured = figure.panels[0].series.back();
    EXPECT_EQ(measured.title, "r");
    ASSERT_GE(measured.points.size(), 6);
    for (const PlanePoint& point : measured.points) {
        EXPECT_TRUE(std::abs(point.x - 1) < 1e-6 || std::abs(point.x - 2) < 1e-6) << point.x;
        EXPECT_NEAR(point.y, 4, 1e-4);
    }
    EXPECT_LT(figure.panels[0].x_range->first, 1); // the axis includes all measured points
    EXPECT_GT(figure.panels[0].x_range->second, 2);
    EXPECT_THROW(make_picture(study.pictures[1], file), InputError); // no values of the same name
}

TEST_F(RecordPictures, RowsOfRecordsHaveHistoriesAndSpectra) {
    folder_.write("a.csv", waves(2, 1.999)); // ten periods
    folder_.write("b.csv", waves(2, 20));
    const Study study = read_study(folder_.write("s.toml", std::string(head) + R"(files = ["a.csv", "b.csv"]
[runs.a]
kind = "record"
files = "a.csv"
[pictures.spectrum]
kind = "spectrum"
run = "a"
y = "V"
[pictures.long]
kind = "spectrum"
run = "r"
y = "V"
[pictures.history]
kind = "history"
run = "r"
)"));
    ResultFile file(folder_ / "results.sqlite", ResultFile::Access::write);
    run_study(study, file, {});
    const auto peak = [&](std::size_t picture) {
        PlanePoint highest;
        const Figure figure = make_picture(study.pictures[picture], file).figure;
        for (const PlanePoint& point : figure.panels[0].series[0].points)
            highest = point.y > highest.y ? point : highest;
        return highest;
    };
    EXPECT_NEAR(peak(0).x, frequency, 1e-9);
    EXPECT_NEAR(peak(0).y, 2, 1e-9);                      // whole periods: no leakage
    EXPECT_NEAR(peak(1).x, frequency, 0.5 * 1000 / 8192); // the nearest frequency of the parts
    EXPECT_NEAR(peak(1).y, 2, 2 * 0.15);                  // Hann's window between two frequencies: 15 % less
    const Figure history = make_picture(study.pictures[2], file).figure;
    ASSERT_EQ(history.panels.size(), 2);
    EXPECT_LE(history.panels[0].series[0].points.size(), 4000); // of 20001
    double highest = 0;
    for (const PlanePoint& point : history.panels[0].series[0].points)
        highest = std::max(highest, point.y);
    EXPECT_NEAR(highest, 2, 1e-12); // extrema are kept
}

} // namespace graze::record_picture_test
