#include "program/run_graze.hpp"
#include "program/started_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <random>
#include <thread>

namespace graze::testing::merge_command_test {

using ::testing::HasSubstr;
using ::testing::Not;

const char* const study = R"(
name = "quick"
model = "impact-oscillator"
set = { sigma = 0.5, omega = 1.2, amplitude = 0.1 }
[runs.sweep]
kind = "sweep"
vary = { amplitude = { from = 0.1, to = 0.3, points = 6 }, omega = { from = 1.1, to = 1.3, points = 5 } }
cycles = 30
[runs.orbit]
kind = "orbit"
[runs.branch]
kind = "continue"
start = { run = "orbit" }
along = { amplitude = [0.05, 0.6] }
steps = 20
[runs.after]
kind = "sweep"
start = { run = "sweep" }
vary = { amplitude = { from = 0.3, to = 0.4, points = 4 } }
cycles = 30
[pictures.diagram]
run = "sweep"
)";

class MergeCommand : public ::testing::Test {
protected:
    MergeCommand() { folder.write("study.toml", study); }
    std::string path(const std::string& name) const { return folder / name; }
    std::vector<std::string> part_of(const std::string& output, const std::string& part) const {
        return {"run", path("study.toml"), "--output", path(output), "--part", part, "--format", "csv"};
    }
    std::string everything(const std::string& output) const {
        std::string all;
        for (const char* what : {"points", "samples"})
            for (const char* run : {"sweep", "after"})
                all += done({"export", path(output), "--run", run, "--what", what, "--format", "csv"});
        for (const char* run : {"orbit", "branch"})
            all += done({"export", path(output), "--run", run, "--format", "csv"});
        return all + done({"export", path(output), "--what", "multipliers", "--format", "csv"});
    }
    std::string whole() const {
        done({"run", path("study.toml"), "--output", path("whole"), "--no-pictures"});
        return everything("whole");
    }
    const Folder folder;
};

TEST_F(MergeCommand, PartsGiveWhatOneProcessGives) {
    for (const char* part : {"1/3", "2/3", "3/3"}) {
        const Printed printed = run_graze(part_of("a", part));
        EXPECT_EQ(printed.code, exit_success) << printed.err;
        EXPECT_THAT(printed.out, HasSubstr("sweep,sweep,30,"));
        EXPECT_THAT(printed.out, HasSubstr("in part"));
        EXPECT_THAT(printed.err, HasSubstr("run 'after' waits for runs that several parts compute"));
    }
    EXPECT_TRUE(std::filesystem::exists(path("a/parts/2-of-3.sqlite")));
    EXPECT_FALSE(std::filesystem::exists(path("a/results.sqlite")));
    const Printed first = run_graze({"merge", path("a")});
    EXPECT_EQ(first.code, exit_irregular);
    EXPECT_THAT(first.err, HasSubstr("run 'after' can begin now that the runs that it needs are complete"));
    EXPECT_FALSE(std::filesystem::exists(path("a/diagram.png"))) << "it would lack what is missing";
    for (const char* part : {"1/3", "2/3", "3/3"})
        EXPECT_THAT(run_graze(part_of("a", part)).err, Not(HasSubstr("waits")));
    const std::string printed = done({"merge", path("a") + "/", "--format", "csv"});
    EXPECT_THAT(printed, HasSubstr("sweep,sweep,30,0,"));
    EXPECT_THAT(printed, HasSubstr("after,sweep,4,4,"));
    EXPECT_TRUE(std::filesystem::exists(path("a/diagram.png")));
    EXPECT_EQ(everything("a"), whole());
    // All is there: nothing is computed.
    EXPECT_THAT(done({"run", path("study.toml"), "--output", path("a"), "--format", "csv"}), Not(HasSubstr(",done,")));
}

TEST_F(MergeCommand, FilesOfPartsMayBeInSeveralFolders) {
    done(part_of("a", "1/2"));
    done(part_of("b", "2/2"));
    const std::string one = path("a/parts/1-of-2.sqlite"), two = path("b/parts/2-of-2.sqlite");
    EXPECT_EQ(run_graze({"merge", one, two, "--output", path("c"), "--quiet"}).code, exit_irregular); // `after` waits
    EXPECT_EQ(run_graze({"merge", path("a"), path("b/parts"), "--output", path("c")}).code, exit_irregular);
    // The rest by one process, which needs no parts any more.
    done({"run", path("study.toml"), "--output", path("c"), "--no-pictures"});
    EXPECT_EQ(everything("c"), whole());
    expect_refusal({"merge", one, two}, "it is not said where the results go");
}

TEST_F(MergeCommand, WhatIsMissingIsSaid) {
    done(part_of("a", "1/4"));
    done(part_of("a", "4/4"));
    const Printed printed = run_graze({"merge", path("a/parts")});
    EXPECT_EQ(printed.code, exit_irregular);
    EXPECT_THAT(printed.err, HasSubstr("of 30 points are missing"));
    EXPECT_THAT(printed.err, HasSubstr("not there: part 2-3 of 4"));
    EXPECT_TRUE(std::filesystem::exists(path("a/results.sqlite")));
    EXPECT_THAT(done({"info", path("a")}), HasSubstr("unfinished"));
}

TEST_F(MergeCommand, MistakesAreReported) {
    for (const char* wrong : {"0/3", "4/3", "3", "a/b", "1/3/5"})
        expect_refusal(part_of("a", wrong), "is no part of a study");
    expect_refusal({"merge", path("none")}, "none");
    std::filesystem::create_directory(path("empty"));
    expect_refusal({"merge", path("empty")}, "there are no parts of a study in this folder");
    done({"run", path("study.toml"), "--output", path("a"), "--only", "orbit", "--no-pictures"});
    expect_refusal({"merge", path("a/results.sqlite"), "--output", path("b")}, "this is no part of a study");
    folder.write("text.sqlite", "no database");
    expect_refusal({"merge", path("text.sqlite"), "--output", path("b")}, "no result file");
    EXPECT_EQ(run_graze(std::vector<std::string>{"merge"}).code, exit_bad_input);
    expect_refusal({"run", "--list", "--part", "1/2"}, "--part");
}

TEST_F(MergeCommand, PartsOfOtherValuesAreRefused) {
    std::vector<std::string> other = part_of("b", "2/2");
    other.insert(other.end(), {"--set", "zeta=0.02"});
    done(part_of("a", "1/2"));
    done(other);
    expect_refusal({"merge", path("a"), path("b"), "--output", path("c")}, "zeta");
}

TEST_F(MergeCommand, PartsThatAreKilledGiveTheSame) {
    const std::string expected = whole();
    std::mt19937 random(5);
    const std::vector<std::string> parts{"1/2", "2/2"};
    int kills = 0;
    for (const std::string& part : parts)
        for (int attempt = 0;; ++attempt) {
            ASSERT_LT(attempt, 200);
            StartedProcess process(part_of("a", part), path("log"));
            std::this_thread::sleep_for(std::chrono::milliseconds(5 + random() % 60 + 20U * attempt));
            if (process.ended() == 0)
                break;
            process.signal(attempt % 2 == 0 ? SIGKILL : SIGTERM);
            process.wait();
            ++kills;
            run_graze({"merge", path("a"), "--quiet"}); // what is there, in between
        }
    EXPECT_GT(kills, 0);
    done({"run", path("study.toml"), "--output", path("a"), "--no-pictures"});
    EXPECT_EQ(everything("a"), expected);
}

} // namespace graze::testing::merge_command_test
