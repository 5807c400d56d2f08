// A study with a failed run: every list reports it with a remedy, and the results of the other runs can be used.

#include "run_graze.hpp"

#include <gmock/gmock.h>

namespace graze::testing::failed_run_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class FailedRun : public ::testing::Test {
protected:
    FailedRun() {
        write("GR1");
        first = run();
    }
    void write(const std::string& point) const {
        std::ofstream(folder / "two.toml")
            << "name = \"two\"\nmodel = \"impact-oscillator\"\n"
               "[runs.rest]\nkind = \"orbit\"\nset = { omega = 4 }\nfrom = { x = -0.07 }\n"
               "[runs.bad]\nkind = \"continue\"\nstart = { run = \"rest\", point = \""
            << point
            << "\" }\nalong = { omega = [3.9, 4.1] }\n"
               "[runs.after]\nkind = \"continue\"\nstart = { run = \"bad\", point = \"EP1\" }\n"
               "along = { omega = [3.9, 4.1] }\n"
               "[runs.free]\nkind = \"continue\"\nstart = { run = \"rest\" }\n"
               "along = { omega = [3.9, 4.1] }\n"
               "[pictures.both]\nkind = \"branch\"\nruns = [\"free\", \"bad\"]\n"
               "y = \"period\"\nformat = \"svg\"\n";
    }
    Printed run() const {
        return run_graze(std::vector<std::string>{"run", folder / "two.toml", "--output", folder / "out"});
    }
    const Folder folder;
    const std::string out = folder / "out";
    Printed first;
    static constexpr const char* why = "run 'rest' has no point 'GR1'; it has EP1";
};

TEST_F(FailedRun, IsListedWithItsReasonByEveryCommand) {
    EXPECT_EQ(first.code, exit_irregular) << first.err;
    const std::string runs = run_graze({"export", out, "--what", "runs", "--format", "csv"}).out;
    EXPECT_THAT(runs, AllOf(HasSubstr("bad,continue,failed,"), HasSubstr(why), HasSubstr("free,continue,complete,")));
    EXPECT_THAT(runs, HasSubstr("after,continue,failed,"));
    EXPECT_THAT(runs, HasSubstr("\"run 'bad', from which it starts, failed; mend that one first\""));
    EXPECT_THAT(runs, Not(HasSubstr("unfinished")));
    const Printed info = run_graze({"info", out});
    EXPECT_THAT(info.out, HasSubstr("run bad failed: "));
    EXPECT_THAT(info.out, Not(HasSubstr("unfinished")));
    const Printed points = run_graze({"points", out});
    EXPECT_EQ(points.code, 0);
    EXPECT_THAT(points.err, AllOf(HasSubstr("graze: run 'bad' failed: "), HasSubstr(why)));
}

TEST_F(FailedRun, DoesNotPreventPicturesOfOtherRuns) {
    EXPECT_THAT(first.err, HasSubstr("picture 'both' was drawn without run 'bad', which has no points"));
    EXPECT_THAT(contents(folder / "out/both.svg"), HasSubstr("</svg>"));
    const std::string picture = folder / "all.svg";
    const Printed together = run_graze({"plot", out, "--output", picture});
    EXPECT_EQ(together.code, exit_irregular);
    EXPECT_EQ(together.out, picture + "\n");
    EXPECT_THAT(together.err, AllOf(HasSubstr("run 'bad' was not drawn: it failed: "), HasSubstr(why)));
    const Printed named = run_graze({"plot", out, "--run", "bad", "--output", folder / "bad.svg"});
    EXPECT_EQ(named.code, exit_bad_input);
    EXPECT_THAT(named.err, AllOf(HasSubstr("run 'bad' has no points: it failed: "), HasSubstr(why)));
    done({"plot", out, "--run", "free", "--output", folder / "free.svg"});
}

TEST_F(FailedRun, IsNotListedAsFailedAfterItSucceeds) {
    const Printed again = run(); // fails again
    EXPECT_EQ(again.code, exit_irregular);
    EXPECT_THAT(again.err, HasSubstr(why));
    write("EP1");
    done(run());
    const std::string runs = run_graze({"export", out, "--what", "runs", "--format", "csv"}).out;
    EXPECT_THAT(runs, AllOf(Not(HasSubstr("failed")), Not(HasSubstr(why))));
}

} // namespace graze::testing::failed_run_test
