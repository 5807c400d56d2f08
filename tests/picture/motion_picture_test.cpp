#include "graze/picture/result_picture.hpp"
#include "graze/study/runner.hpp"

#include "base/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <set>

namespace graze::motion_picture_test {

using ::testing::Contains;
using ::testing::IsSupersetOf;
using ::testing::Not;

/// Motions with and without impacts, whose contacts are sampled or not, and an orbit without impacts.
const std::string text = R"(name = "s"
model = "impact-oscillator"
[runs.plain]
kind = "simulate"
time = 20
[runs.sampled]
kind = "simulate"
time = 20
sample = { impacts = { contacts = ["stop"] } }
[runs.free]
kind = "simulate"
set = { sigma = 50 }
from = { x = 0 }
time = 5
[runs.orbit]
kind = "orbit"
set = { omega = 4 }
from = { x = -0.07 }
[runs.impacting]
kind = "orbit"
set = { omega = 2.8 }
)";

/// The titles of what the history of each run draws.
class MotionPicture : public ::testing::Test {
protected:
    std::set<std::string> titles(const std::string& run) const {
        StudyPicture picture;
        picture.kind = "history";
        picture.runs = {run};
        std::set<std::string> found;
        for (const FigurePanel& panel : make_picture(picture, file_).figure.panels)
            for (const FigureSeries& series : panel.series) {
                EXPECT_TRUE(series.only_in_legend || !series.points.empty()) << run << ": " << series.title;
                found.insert(series.title);
            }
        return found;
    }

private:
    static ResultFile computed(const std::string& path) {
        ResultFile file(path, ResultFile::Access::write);
        for (const RunReport& report : run_study(parse_study(text, "s.toml"), file, {}))
            EXPECT_TRUE(report.complete()) << report.name << ": " << report.problem;
        return file;
    }
    testing::TemporaryFolder folder_;
    ResultFile file_ = computed(folder_ / "results.sqlite");
};

TEST_F(MotionPicture, LegendNamesOnlyWhatIsDrawn) {
    EXPECT_THAT(titles("plain"), IsSupersetOf({"jump", "impact"}));
    EXPECT_THAT(titles("free"), Not(Contains("jump")));
    EXPECT_THAT(titles("free"), Not(Contains("impact")));
    EXPECT_THAT(titles("impacting"), IsSupersetOf({"jump", "event"}));
    EXPECT_THAT(titles("orbit"), Not(Contains("jump")));
    EXPECT_THAT(titles("orbit"), Not(Contains("event")));
}

TEST_F(MotionPicture, MarksNoContactThatIsASample) {
    const std::set<std::string> all = titles("sampled");
    EXPECT_THAT(all, IsSupersetOf({"jump", "impacts"}));
    EXPECT_THAT(all, Not(Contains("impact")));
}

} // namespace graze::motion_picture_test
