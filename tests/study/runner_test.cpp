#include "graze/study/run_times.hpp"
#include "graze/study/runner.hpp"

#include "study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

namespace graze::runner_test {

using ::testing::HasSubstr;

const char* const text = R"(
name = "s"
model = "impact-oscillator"
[runs.sweep]
kind = "sweep"
vary = { omega = { from = 2.7, to = 2.9, step = 0.02 } }
direction = "both"
cycles = 60
[runs.basin]
kind = "basin"
draws = 9
vary = { x = { random = [-1, 0] } }
cycles = 60
start = { run = "sweep", at = { omega = 2.8 }, direction = "up" }
)";

using RunnerTest = testing::StudyFixture;

TEST_F(RunnerTest, ComputesEachRunOnce) {
    const Study study = parse_study(text, "s.toml");
    ResultFile file(path_, ResultFile::Access::write);
    const auto first = run_study(study, file, {.jobs = 2});
    ASSERT_EQ(first.size(), 2u);
    EXPECT_EQ(first[0].points, 22u);
    EXPECT_EQ(first[0].computed, 22u);
    EXPECT_EQ(first[1].computed, 9u);
    const auto second = run_study(study, file, {.jobs = 2});
    EXPECT_EQ(second[0].computed, 0u);
    EXPECT_EQ(second[1].computed, 0u);
    EXPECT_TRUE(second[1].complete());
}

TEST_F(RunnerTest, RepeatsOnlyRunsThatHaveChanged) {
    Study study = parse_study(text, "s.toml");
    ResultFile file(path_, ResultFile::Access::write);
    run_study(study, file, {});
    study.runs[1].attractor().cycles = 61;
    auto reports = run_study(study, file, {});
    EXPECT_EQ(reports[0].computed, 0u);
    EXPECT_EQ(reports[1].computed, 9u);
    study.runs[0].motion().simulation.tolerance = 1e-11; // the basin starts from the sweep
    reports = run_study(study, file, {});
    EXPECT_EQ(reports[0].computed, 22u);
    EXPECT_EQ(reports[1].computed, 9u);
}

TEST_F(RunnerTest, ContinuesFromAnyPointToTheSameBits) {
    const Study study = parse_study(text, "s.toml");
    std::string whole;
    {
        ResultFile file(folder_ / "whole.sqlite", ResultFile::Access::write);
        run_study(study, file, {});
        whole = testing::bits_of(file);
    }
    ResultFile file(path_, ResultFile::Access::write);
    std::size_t interruptions = 0;
    for (std::size_t stop_after = 1;; ++stop_after) {
        std::atomic<std::size_t> done{0};
        const auto reports = run_study(study, file,
                                       {.jobs = 1 + static_cast<int>(stop_after % 3),
                                        .interrupted = [&] { return done >= stop_after; },
                                        .progress = [&](const StudyProgress&) { ++done; }});
        if (reports.back().complete() && reports.size() == 2)
            break;
        ++interruptions;
        ASSERT_LT(interruptions, 100u);
    }
    EXPECT_GT(interruptions, 3u);
    EXPECT_EQ(testing::bits_of(file), whole);
}

TEST_F(RunnerTest, TellsWhereARunCannotStart) {
    Study study = parse_study(text, "s.toml");
    study.runs[1].start->coordinate = "e";
    ResultFile file(path_, ResultFile::Access::write);
    const auto reports = run_study(study, file, {});
    EXPECT_EQ(reports[0].outcome, RunOutcome::complete);
    EXPECT_EQ(reports[1].outcome, RunOutcome::failed);
    EXPECT_THAT(reports[1].problem, HasSubstr("s.toml:14:1: run 'sweep' has no coordinate 'e'"));
    EXPECT_FALSE(reports[1].remedy.empty());
    EXPECT_EQ(file.point_count("sweep"), 22u); // nothing is lost
    // The file knows why, as long as it is so.
    const std::string failed = reports[1].name;
    EXPECT_EQ(file.find_run(failed)->status, RunStatus::failed);
    EXPECT_EQ(file.find_run(failed)->failure, reports[1].problem + "; " + reports[1].remedy);
    EXPECT_EQ(file.find_run("sweep")->status, RunStatus::complete);
    EXPECT_EQ(file.find_run("sweep")->failure, "");
    run_study(parse_study(text, "s.toml"), file, {});
    EXPECT_EQ(file.find_run(failed)->status, RunStatus::complete);
    EXPECT_EQ(file.find_run(failed)->failure, "");
}

} // namespace graze::runner_test
