#include "program/step_lines.hpp"

#include "run_graze.hpp"

#include <gmock/gmock.h>

namespace graze::testing::step_lines_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// An oscillator whose force grows until it grazes its stop.
constexpr const char* study = R"(
name = "onset"
model = "impact-oscillator"
set = { sigma = 0.5 }
[runs.start]
kind = "orbit"
set = { amplitude = 0.5 }
[runs.rising]
kind = "continue"
start = { run = "start" }
along = { amplitude = [0.1, 4] }
direction = "up"
[runs.rising.monitors]
top = { maximum = "x" }
)";

TEST(StepLines, HaveOneLineForEachOrbit) {
    const Folder folder;
    std::ofstream(folder / "onset.toml") << study;
    const std::vector<std::string> words{"run", folder / "onset.toml", "--output", folder / "onset", "--no-pictures"};
    std::vector<std::string> loud = words;
    loud.emplace_back("--steps");
    const Printed run = run_graze(loud);
    ASSERT_EQ(run.code, 0) << run.err;
    const std::vector<std::string> lines = split(run.err, '\n');
    ASSERT_GT(lines.size(), 6U);
    EXPECT_EQ(lines[0], "start");
    EXPECT_EQ(lines[3], "rising, up");
    EXPECT_THAT(lines[4], StartsWith(" step type label           amplitude"));
    EXPECT_THAT(lines[4], HasSubstr(" top"));
    EXPECT_THAT(lines[5], StartsWith("    0 EP   EP1                   0.5 "));
    EXPECT_THAT(run.err, HasSubstr(" GR   GR1 "));
    for (std::size_t i = 6; i < lines.size(); ++i)
        EXPECT_EQ(lines[i].size(), lines[5].size()) << lines[i];
    // The table at the end counts the special points.
    EXPECT_THAT(run.out, HasSubstr("GR 1"));
    EXPECT_THAT(run_graze(words).out, HasSubstr("was there"));
    EXPECT_EQ(run_graze(words).err, "");
}

} // namespace graze::testing::step_lines_test
