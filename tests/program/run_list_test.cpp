// The list of runs at the end of `graze run`: their status, and remedies for failures.

#include "run_graze.hpp"

#include <gmock/gmock.h>

namespace graze::testing::run_list_test {

using ::testing::HasSubstr;

class RunList : public ::testing::Test {
protected:
    RunList() {
        // A ball whose bounces accumulate; the model does not tell what follows.
        std::ofstream(folder / "ball.toml") << R"(
name = "ball"
[parameters]
e = 0.5
[states]
h = 1
v = 0
[modes.flight]
rates = { h = "v", v = -10 }
watch = ["floor"]
[events]
floor = "h"
[jumps.bounce]
v = "-e*v"
[[transitions]]
mode = "flight"
event = "floor"
jump = "bounce"
next = "flight"
)";
        std::ofstream(folder / "study.toml") << R"(
name = "study"
model = "ball.toml"
[runs.bouncing]
kind = "simulate"
time = 10
sample = { top = { maxima = "h" } }
[runs.short]
kind = "simulate"
time = 0.25
sample = { top = { maxima = "h" } }
)";
    }
    Printed list(const std::string& format) const {
        return run_graze(
            {"run", folder / "study.toml", "--output", folder / "out", "--no-pictures", "--format", format});
    }
    Folder folder;
};

TEST_F(RunList, HasARemedyForChattering) {
    const std::string printed = done(list("table"));
    EXPECT_THAT(printed, HasSubstr("chattering 1"));
    EXPECT_THAT(printed, HasSubstr("point 0: "));
    EXPECT_THAT(printed, HasSubstr("give it `chatter = "));
}

TEST_F(RunList, FitsATerminalOfAHundredColumns) {
    std::string study = contents(folder / "study.toml");
    study.replace(study.find("bouncing"), 8, "bouncing_until_it_comes_to_rest");
    std::ofstream(folder / "study.toml") << study;
    for (const std::string& line : split(list("table").out, '\n'))
        EXPECT_LE(line.size(), 100U) << line;
}

TEST_F(RunList, HasACellForEachNumberInCsv) {
    const Printed printed = list("csv");
    EXPECT_EQ(header(printed.out),
              "run,kind,points,computed,seconds,status,points_chattering,points_ended,problem,rate_of_escape");
    const std::string first = split(printed.out, '\n').at(1), second = split(printed.out, '\n').at(2);
    EXPECT_THAT(first, HasSubstr(",done,1,0,\"point 0: "));
    EXPECT_TRUE(second.ends_with(",done,0,1,,")) << second;
    EXPECT_TRUE(JsonCheck(list("json").out).valid());
}

} // namespace graze::testing::run_list_test
