// A study gives the same results, in the same order, however many of its runs go at a time.

#include "study_fixture.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <mutex>
#include <set>
#include <thread>

namespace graze::side_by_side_test {

constexpr const char* text = R"(
name = "s"
model = "impact-oscillator"
set = { sigma = 0.5, omega = 1.2, amplitude = 0.1 }
[runs.rest]
kind = "orbit"
[runs.branch]
kind = "continue"
direction = "up"
start = { run = "rest" }
along = { amplitude = [0.05, 0.6] }
steps = 30
[runs.one]
kind = "sweep"
vary = { amplitude = { from = 0.1, to = 0.3, points = 6 } }
cycles = 20
[runs.two]
kind = "sweep"
vary = { omega = { from = 1.1, to = 1.3, points = 5 }, amplitude = [0.1, 0.2] }
cycles = 20
[runs.after]
kind = "sweep"
start = { run = "one" }
vary = { amplitude = { from = 0.3, to = 0.4, points = 4 } }
cycles = 20
[runs.wrong]
kind = "sweep"
start = { run = "branch", point = "GR9" }
vary = { amplitude = { from = 0.3, to = 0.4, points = 4 } }
cycles = 20
[runs.lost]
kind = "simulate"
start = { run = "wrong" }
time = 1
)";

using SideBySide = testing::StudyFixture;
using testing::bits_of;

TEST_F(SideBySide, ResultsAndTheirOrderDoNotDependOnThreads) {
    const Study study = parse_study(text, "s.toml");
    std::string alone;
    std::vector<std::string> outcomes;
    for (const int jobs : {1, 2, 3, 8}) {
        std::filesystem::remove(path_);
        ResultFile file(path_, ResultFile::Access::write);
        const std::vector<RunReport> reports = run_study(study, file, {.jobs = jobs});
        std::vector<std::string> here;
        for (const RunReport& report : reports)
            here.push_back(report.name + " " + std::to_string(static_cast<int>(report.outcome)) + " " +
                           std::to_string(report.computed) + " " + report.problem);
        if (jobs == 1) {
            alone = bits_of(file);
            outcomes = here;
            ASSERT_EQ(reports.size(), 7U);
            EXPECT_EQ(reports[5].outcome, RunOutcome::failed);
            EXPECT_EQ(reports[6].outcome, RunOutcome::skipped);
        }
        EXPECT_EQ(bits_of(file), alone) << jobs;
        EXPECT_EQ(here, outcomes) << jobs;
    }
}

TEST_F(SideBySide, ContinuesToTheSameResultsWhereverItIsInterrupted) {
    const Study study = parse_study(text, "s.toml");
    std::string whole;
    {
        ResultFile file(folder_ / "other.sqlite", ResultFile::Access::write);
        run_study(study, file, {});
        whole = bits_of(file);
    }
    ResultFile file(path_, ResultFile::Access::write);
    std::size_t interruptions = 0;
    for (std::size_t stop_after = 1;; stop_after += 3) {
        std::atomic<std::size_t> done{0};
        RunnerOptions options;
        options.jobs = 3;
        options.interrupted = [&] { return done >= stop_after; };
        options.progress = [&](const StudyProgress&) { ++done; };
        options.orbit = [&](const std::string&, const OrbitRecord&) { ++done; };
        bool interrupted = false;
        for (const RunReport& report : run_study(study, file, options))
            interrupted = interrupted || report.outcome == RunOutcome::interrupted;
        if (!interrupted)
            break;
        ASSERT_LT(++interruptions, 60U);
    }
    EXPECT_GT(interruptions, 3U);
    EXPECT_EQ(bits_of(file), whole);
}

TEST_F(SideBySide, ReportsProgressFromOneThreadAtATimeWithRightCounts) {
    const Study study = parse_study(text, "s.toml");
    ResultFile file(path_, ResultFile::Access::write);
    std::mutex alone;
    std::set<std::thread::id> threads;
    StudyProgress last;
    std::size_t calls = 0;
    RunnerOptions options;
    options.jobs = 4;
    options.progress = [&](const StudyProgress& progress) {
        ASSERT_TRUE(alone.try_lock());
        threads.insert(std::this_thread::get_id());
        EXPECT_EQ(progress.computed, ++calls);
        EXPECT_LE(progress.done, progress.points);
        EXPECT_LE(progress.study_done, progress.study_points);
        EXPECT_GE(progress.study_done, last.study_done);
        // 6 + 10 + 4, and what cannot be done: 4 + 1.
        EXPECT_EQ(progress.study_points, 25U);
        EXPECT_EQ(progress.points, progress.run == "one" ? 6U : progress.run == "two" ? 10U : 4U);
        last = progress;
        alone.unlock();
    };
    options.orbit = [&](const std::string&, const OrbitRecord&) {
        ASSERT_TRUE(alone.try_lock());
        alone.unlock();
    };
    run_study(study, file, options);
    EXPECT_EQ(calls, 20U);
    EXPECT_EQ(last.branches_left <= 2, true);
}

TEST_F(SideBySide, AnExceptionOfTheCallerEndsAllRuns) {
    const Study study = parse_study(text, "s.toml");
    ResultFile file(path_, ResultFile::Access::write);
    const auto enough = [](const StudyProgress&) { throw std::runtime_error("enough"); };
    EXPECT_THROW(run_study(study, file, {.jobs = 3, .progress = enough}), std::runtime_error);
    run_study(study, file, {.jobs = 3});
    ResultFile other(folder_ / "other.sqlite", ResultFile::Access::write);
    run_study(study, other, {});
    EXPECT_EQ(bits_of(file), bits_of(other));
}

} // namespace graze::side_by_side_test
