#include "program/run_graze.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

namespace graze {
namespace {

using ::testing::HasSubstr;
using testing::run_graze;
using ::testing::StartsWith;

const char* const study = R"(
name = "quick"
model = "electromagnetic-testbed"
values = ["v", "I"]
[runs.sweep]
kind = "sweep"
vary = { V0 = { from = 4.82, to = 4.86, step = 0.001 } }
direction = "both"
cycles = 60
lyapunov_cycles = 40
[runs.basin]
kind = "basin"
vary = { q = { from = -0.001, to = 0.001, points = 4 }, v = { from = -0.1, to = 0.1, points = 4 } }
cycles = 60
)";

class RunStudyTest : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ =
            std::filesystem::temp_directory_path() / ("graze-study-" + std::to_string(getpid()) + "-" +
                                                      ::testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
        std::ofstream(path("study.toml")) << study;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    testing::Printed study_run(const std::string& output) {
        return run_graze({"run", path("study.toml"), "--output", path(output), "--no-pictures", "--format", "csv"});
    }
    std::string everything(const std::string& output) {
        std::string all;
        for (const char* what : {"points", "samples"})
            for (const char* run : {"sweep", "basin"})
                all += run_graze({"export", path(output), "--run", run, "--what", what, "--format", "csv"}).out;
        return all + run_graze({"export", path(output), "--what", "multipliers", "--format", "csv"}).out;
    }
    std::filesystem::path folder_;
};

TEST_F(RunStudyTest, a_study_is_run_once_and_exported) {
    const testing::Printed first = study_run("a");
    EXPECT_EQ(first.code, 0) << first.err;
    EXPECT_THAT(first.out, HasSubstr("sweep,sweep,82,82,"));
    EXPECT_THAT(first.out, HasSubstr("basin,basin,16,16,"));
    EXPECT_THAT(study_run("a").out, HasSubstr("was there"));
    const testing::Printed points =
        run_graze({"export", path("a"), "--run", "sweep", "--label", "periodic", "--format", "csv"});
    EXPECT_EQ(points.code, 0) << points.err;
    EXPECT_THAT(points.out, StartsWith("number,chain,direction,V0,label,period,duration,signature,"));
    const testing::Printed query = run_graze({"export", path("a"), "--sql", "SELECT 1 + 1 AS two", "--format", "csv"});
    EXPECT_EQ(query.out, "two\n2\n");
    const testing::Printed hdf5 = run_graze({"export", path("a"), "--format", "hdf5", "--output", path("a.h5")});
    EXPECT_EQ(hdf5.code, 0) << hdf5.err;
    EXPECT_GT(std::filesystem::file_size(path("a.h5")), 10'000u);
    EXPECT_THAT(run_graze({"export", path("a"), "--what", "runs"}).out, HasSubstr("complete"));
}

TEST_F(RunStudyTest, wrong_inputs_are_told_and_change_nothing) {
    EXPECT_EQ(run_graze(std::vector<std::string>{"run"}).code, 2);
    EXPECT_THAT(run_graze("run mems-swich").err, HasSubstr("did you mean 'mems-switch'?"));
    EXPECT_THAT(run_graze("run " + path("none.toml")).err, HasSubstr("the study cannot be read"));
    EXPECT_THAT(run_graze({"run", path("study.toml"), "--only", "swep"}).err, HasSubstr("did you mean 'sweep'?"));
    EXPECT_THAT(run_graze({"run", path("study.toml"), "--output", path("study.toml")}).err,
                HasSubstr("cannot be made"));
    EXPECT_THAT(run_graze("export " + path("none")).err, HasSubstr("there is no such result file"));
    ASSERT_EQ(study_run("a").code, 0);
    EXPECT_THAT(run_graze({"export", path("a"), "--run", "swep"}).err, HasSubstr("did you mean 'sweep'?"));
    EXPECT_THAT(run_graze("export " + path("a")).err, HasSubstr("export one of them at a time"));
    EXPECT_EQ(run_graze({"export", path("a"), "--sql", "DROP TABLE runs"}).code, 2);
    EXPECT_EQ(run_graze({"export", path("a"), "--sql", "SELECT nothing FROM nowhere"}).code, 2);
    EXPECT_THAT(run_graze({"plot", path("a"), "--run", "sweep", "--y", "w", "--output", path("x.png")}).err,
                HasSubstr("has no value 'w'"));
    EXPECT_FALSE(std::filesystem::exists(path("x.png")));
}

TEST_F(RunStudyTest, pictures_of_every_kind_are_drawn) {
    ASSERT_EQ(study_run("a").code, 0);
    const auto drawn = [&](std::vector<std::string> options) {
        std::vector<std::string> words{"plot", path("a"), "--output", path("p.svg")};
        words.insert(words.end(), options.begin(), options.end());
        std::filesystem::remove(path("p.svg"));
        const testing::Printed run = run_graze(words);
        EXPECT_EQ(run.code, 0) << run.err;
        return std::filesystem::exists(path("p.svg")) ? std::filesystem::file_size(path("p.svg")) : 0;
    };
    EXPECT_GT(drawn({"--run", "sweep"}), 10'000u);
    EXPECT_GT(drawn({"--run", "basin"}), 2'000u);
    EXPECT_GT(drawn({"--run", "sweep", "--kind", "portrait", "--x", "I", "--y", "v", "--at", "V0=4.85"}), 5'000u);
    EXPECT_GT(drawn({"--run", "sweep", "--kind", "history", "--y", "v", "--at", "V0=4.85"}), 5'000u);
    EXPECT_GT(drawn({"--run", "sweep", "--kind", "spectrum", "--y", "I", "--at", "V0=4.85"}), 2'000u);
    EXPECT_GT(drawn({"--run", "sweep", "--kind", "scatter", "--y", "lyapunov"}), 2'000u);
    EXPECT_GT(drawn({"--run", "sweep", "--kind", "regression", "--y", "I"}), 2'000u);
}

#ifdef GRAZE_PROGRAM
/// Starts the program and kills it after a while. @return whether it had ended by itself
bool run_and_kill(const std::vector<std::string>& words, std::chrono::microseconds after) {
    const pid_t child = fork();
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, 1);
        dup2(nowhere, 2);
        std::vector<char*> arguments;
        for (const std::string& word : words)
            arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        execv(GRAZE_PROGRAM, arguments.data());
        _exit(127);
    }
    std::this_thread::sleep_for(after);
    int status = 0;
    const bool ended = waitpid(child, &status, WNOHANG) == child;
    if (!ended) {
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
    }
    return ended && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

using RunStudySlow = RunStudyTest;

TEST_F(RunStudySlow, killed_at_a_hundred_moments_it_ends_with_the_same_results) {
    ASSERT_EQ(study_run("whole").code, 0);
    const std::string whole = everything("whole");
    std::mt19937 random(7);
    int kills = 0;
    // Each round starts anew once it is complete, so that all moments of a run are met.
    for (int round = 0; kills < 100; ++round) {
        const std::string output = "killed" + std::to_string(round);
        const std::vector<std::string> words{"graze",  "run", path("study.toml"), "--output", path(output),
                                             "--jobs", "2",   "--no-pictures"};
        while (!run_and_kill(words, std::chrono::microseconds(std::uniform_int_distribution<>(2'000, 250'000)(random))))
            ++kills;
        ASSERT_EQ(everything(output), whole) << "after " << kills << " kills";
        std::filesystem::remove_all(path(output));
        ASSERT_LT(round, 200);
    }
}
#endif

TEST_F(RunStudyTest, results_are_gone_on_with_and_done_again_from_their_file_alone) {
    ASSERT_EQ(study_run("a").code, 0);
    const std::string before = everything("a");
    std::filesystem::remove(path("study.toml"));
    const testing::Printed on = run_graze({"run", path("a"), "--no-pictures", "--format", "csv"});
    EXPECT_EQ(on.code, 0) << on.err;
    EXPECT_THAT(on.out, HasSubstr("was there"));
    EXPECT_EQ(on.out.find("done"), std::string::npos);
    const testing::Printed again =
        run_graze({"run", path("a/results.sqlite"), "--output", path("b"), "--only", "sweep,basin"});
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(everything("a"), before);
    EXPECT_EQ(everything("b"), before);
    const testing::Printed drawn = run_graze({"run", path("a")});
    EXPECT_EQ(drawn.code, 0) << drawn.err;
    EXPECT_TRUE(std::filesystem::exists(path("a/sweep.png")));
}

TEST_F(RunStudyTest, what_is_neither_study_nor_results_is_refused) {
    EXPECT_THAT(run_graze({"run", path("none.sqlite")}).err, HasSubstr("there is no such result file"));
    std::ofstream(path("no.sqlite")) << "this is something else, however long it may be";
    EXPECT_THAT(run_graze({"run", path("no.sqlite")}).err, HasSubstr("no result file of graze"));
    EXPECT_NE(run_graze({"run", folder_.string()}).code, 0);
}

} // namespace
} // namespace graze
