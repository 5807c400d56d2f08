// Pictures of curves in two parameters: line styles in the legend.

#include "graze/picture/result_picture.hpp"
#include "graze/study/runner.hpp"

#include "base/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace graze::curve_picture_test {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::string text = R"(name = "s"
model = "impact-oscillator"
set = { sigma = 0.5, omega = 1.2 }
[runs.free]
kind = "continue"
direction = "up"
set = { amplitude = 0.1 }
along = { amplitude = [0.01, 2] }
[runs.hits]
kind = "continue"
direction = "up"
start = { run = "free", point = "GR1" }
along = { amplitude = [0.01, 2] }
[runs.up]
kind = "curve"
direction = "up"
start = { run = "free", point = "GR1" }
along = { omega = [1, 3], amplitude = [0.01, 2] }
steps = 3
[runs.down]
kind = "curve"
start = { run = "free", point = "GR1" }
along = { omega = [1, 3], amplitude = [0.01, 2] }
direction = "down"
steps = 3
[runs.folds]
kind = "curve"
direction = "up"
start = { run = "hits", point = "SN1" }
along = { omega = [1, 3], amplitude = [0.01, 2] }
steps = 3
)";

/// Titles and styles of the legend's entries about styles, which are black.
std::vector<std::pair<std::string, FigureSeries::Style>> meanings(const ResultFile& file,
                                                                  const std::vector<std::string>& runs) {
    StudyPicture picture;
    picture.runs = runs;
    std::vector<std::pair<std::string, FigureSeries::Style>> found;
    const ResultPicture made = make_picture(picture, file);
    for (const FigureSeries& series : made.figure.panels.at(0).series)
        if (series.only_in_legend && series.colour == FigureSeries::black &&
            series.style != FigureSeries::Style::symbols)
            found.emplace_back(series.title, series.style);
    return found;
}

TEST(CurvePicture, LegendExplainsStylesUnlessEachBelongsToOneRun) {
    const testing::TemporaryFolder folder;
    ResultFile file(folder / "results.sqlite", ResultFile::Access::write);
    for (const RunReport& report : run_study(parse_study(text, "s.toml"), file, {}))
        EXPECT_TRUE(report.complete()) << report.name << ": " << report.problem;
    using Style = FigureSeries::Style;
    EXPECT_THAT(meanings(file, {"up", "down", "folds"}),
                ElementsAre(std::pair("grazing", Style::line), std::pair("fold", Style::dashed)));
    EXPECT_THAT(meanings(file, {"up", "folds"}), IsEmpty());
    EXPECT_THAT(meanings(file, {"up", "down"}), IsEmpty());
}

} // namespace graze::curve_picture_test
