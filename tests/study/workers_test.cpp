#include "graze/study/workers.hpp"

#include "messages_in_threads.hpp"
#include "study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>

namespace graze::workers_test {

using ::testing::HasSubstr;

// Runs of all kinds of tasks: chains that carry states along, single points, runs that need others, one that fails.
const char* const text = R"(
name = "s"
model = "impact-oscillator"
values = ["v", "x + 0.1*v"]
[runs.sweep]
kind = "sweep"
vary = { omega = { from = 2.7, to = 2.9, points = 6 }, sigma = [1.2, 1.25, 1.3] }
direction = "both"
cycles = 60
[runs.basin]
kind = "basin"
draws = 5
vary = { x = { random = [-1, 0] }, omega = [2.7, 2.8] }
cycles = 60
start = { run = "sweep", at = { omega = 2.8 }, direction = "up" }
[runs.orbit]
kind = "orbit"
set = { omega = 4 }
from = { x = -0.07 }
[runs.branch]
kind = "continue"
start = { run = "orbit" }
along = { omega = [3.9, 4.1] }
[runs.nothing]
kind = "continue"
start = { run = "branch", point = "GR7" }
along = { omega = [3.9, 4.1] }
[runs.after_nothing]
kind = "continue"
start = { run = "nothing", point = "GR1" }
along = { omega = [3.9, 4.1] }
[runs.motions]
kind = "simulate"
vary = { v = { from = -2, to = 2, points = 9 } }
periods = 12
bounds = { x = [-1, 2] }
start = { run = "orbit" }
)";

class WorkersTest : public testing::StudyFixture {
protected:
    using Outcomes = std::map<std::string, std::string>;
    static Outcomes outcomes(const std::vector<RunReport>& reports) {
        Outcomes all;
        for (const RunReport& report : reports)
            all[report.name] = std::string(name_of(report.outcome)) + ' ' + report.problem + ' ' + report.remedy + ' ' +
                               std::to_string(report.points);
        return all;
    }
    std::string bits_of_whole(Outcomes* told = nullptr) const {
        ResultFile file(folder_ / "whole.sqlite", ResultFile::Access::write);
        const Outcomes all = outcomes(run_study(study_, file, {}));
        if (told)
            *told = all;
        return testing::bits_of(file);
    }

    const Study study_ = parse_study(text, "s.toml");
};

TEST_F(WorkersTest, MakeTheSameFile) {
    Outcomes expected;
    const std::string bits = bits_of_whole(&expected);
    EXPECT_THAT(expected["nothing"], HasSubstr("failed"));
    EXPECT_THAT(expected["after_nothing"], HasSubstr("skipped"));
    for (const std::size_t count : {1, 2, 3, 5}) {
        testing::WorkersInThreads workers(count, count == 3 ? 2 : 1);
        ResultFile file(folder_ / std::to_string(count), ResultFile::Access::write);
        EXPECT_EQ(outcomes(workers->run_study(study_, file, {})), expected) << count;
        EXPECT_EQ(testing::bits_of(file), bits) << count;
    }
}

TEST_F(WorkersTest, GoOnWithAnotherNumberAfterInterruptions) {
    const std::string bits = bits_of_whole();
    ResultFile file(path_, ResultFile::Access::write);
    bool is_interrupted = true;
    std::size_t interruptions = 0;
    for (std::size_t count = 4; is_interrupted; count = count % 4 + 1) {
        ASSERT_LT(interruptions, 60U);
        testing::WorkersInThreads workers(count);
        std::atomic<std::size_t> done{0};
        is_interrupted = false;
        const std::size_t most = 3 + interruptions; // branches begin again each time
        const auto count_one = [&](auto&&...) { ++done; };
        for (const RunReport& report : workers->run_study(
                 study_, file, {.interrupted = [&] { return done >= most; }, .progress = count_one, .orbit = {}}))
            is_interrupted = is_interrupted || report.outcome == RunOutcome::interrupted;
        interruptions += is_interrupted ? 1 : 0;
    }
    EXPECT_GE(interruptions, 2U);
    EXPECT_EQ(testing::bits_of(file), bits);
    // Alone it finds nothing to do.
    for (const RunReport& report : run_study(study_, file, {}))
        EXPECT_EQ(report.computed, 0U) << report.name;
}

TEST_F(WorkersTest, TellTheProgressOfOneProcess) {
    testing::WorkersInThreads workers(2);
    ResultFile file(path_, ResultFile::Access::write);
    StudyProgress last;
    std::size_t calls = 0;
    workers->run_study(study_, file, {.only = {"sweep"}, .progress = [&](const StudyProgress& made) {
                                          last = made;
                                          ++calls;
                                      }});
    EXPECT_EQ(calls, points_of(*study_.find_run("sweep")));
    EXPECT_EQ(last.study_done, calls);
    EXPECT_EQ(last.study_points, calls);
}

TEST_F(WorkersTest, AreNotAskedForWhatIsThere) {
    ResultFile file(path_, ResultFile::Access::write);
    run_study(study_, file, {});
    testing::WorkersInThreads workers(2);
    for (const RunReport& report : workers->run_study(study_, file, {}))
        if (report.outcome == RunOutcome::complete) {
            EXPECT_EQ(report.computed, 0U) << report.name;
        }
}

TEST_F(WorkersTest, EndWhenACallbackThrows) {
    testing::WorkersInThreads workers(2);
    ResultFile file(path_, ResultFile::Access::write);
    EXPECT_THROW(
        workers->run_study(study_, file, {.progress = [](const StudyProgress&) { throw std::runtime_error("told"); }}),
        std::runtime_error);
    // They compute for another study after that.
    testing::expect_complete(workers->run_study(study_, file, {.only = {"motions"}}));
}

} // namespace graze::workers_test
