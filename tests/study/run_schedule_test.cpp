#include "study/run_schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <random>
#include <stdexcept>
#include <thread>

namespace graze::run_schedule_test {

using ::testing::ElementsAre;

const std::function<bool()> never = [] { return false; };

/// What was done, and in which order runs began and ended.
struct Log {
    std::mutex mutex;
    std::vector<std::size_t> begun, ended;
    std::vector<int> threads;
    int going = 0, most_going = 0;

    void begin(std::size_t run, int given) {
        const std::lock_guard lock(mutex);
        begun.push_back(run);
        threads.push_back(given);
        most_going = std::max(most_going, ++going);
    }
    void end(std::size_t run) {
        const std::lock_guard lock(mutex);
        ended.push_back(run);
        --going;
    }
};

TEST(RunSchedule, OneJobDoesRunsInTheirOrder) {
    Log log;
    run_side_by_side({{}, {.after = {0}}, {.threads = 9}}, 1, never, [&](std::size_t run, int threads) {
        log.begin(run, threads);
        log.end(run);
    });
    EXPECT_THAT(log.begun, ElementsAre(0, 1, 2));
    EXPECT_THAT(log.threads, ElementsAre(1, 1, 1));
    EXPECT_EQ(log.most_going, 1);
}

TEST(RunSchedule, IndependentRunsGoOnSideBySide) {
    // Each waits until all three are there: one after the other this would never end.
    std::atomic<int> there{0};
    run_side_by_side({{}, {}, {}}, 3, never, [&](std::size_t, int) {
        ++there;
        while (there < 3)
            std::this_thread::yield();
    });
    EXPECT_EQ(there, 3);
}

TEST(RunSchedule, ARunBeginsAfterTheOneThatItStartsFrom) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<ScheduledRun> runs(8);
        for (std::size_t r = 1; r < runs.size(); ++r)
            if (random() % 2 == 0)
                runs[r].after = {random() % r};
        const int jobs = 2 + static_cast<int>(random() % 3);
        Log log;
        run_side_by_side(runs, jobs, never, [&](std::size_t run, int threads) {
            {
                const std::lock_guard lock(log.mutex);
                for (const std::size_t before : runs[run].after)
                    EXPECT_THAT(log.ended, ::testing::Contains(before));
            }
            log.begin(run, threads);
            std::this_thread::sleep_for(std::chrono::microseconds(50 * (run % 3)));
            log.end(run);
        });
        EXPECT_EQ(log.ended.size(), runs.size());
        EXPECT_LE(log.most_going, jobs);
    }
}

TEST(RunSchedule, ARunWaitsForAllThatItNeeds) {
    Log log;
    run_side_by_side({{}, {}, {.after = {0, 1}}}, 3, never, [&](std::size_t run, int threads) {
        log.begin(run, threads);
        std::this_thread::sleep_for(std::chrono::milliseconds(run == 0 ? 5 : 1));
        log.end(run);
    });
    EXPECT_EQ(log.ended.back(), 2);
}

TEST(RunSchedule, ARunGetsTheThreadsThatItCanUse) {
    Log log;
    std::vector<int> given(4);
    run_side_by_side({{.threads = 1}, {.threads = 100}, {.threads = 3}, {.threads = 0}}, 4, never,
                     [&](std::size_t run, int threads) {
                         const std::lock_guard lock(log.mutex);
                         given[run] = threads;
                     });
    EXPECT_THAT(given, ElementsAre(1, 4, 3, 1));
}

TEST(RunSchedule, NoRunBeginsAfterAStop) {
    for (const int jobs : {1, 2}) {
        std::atomic<bool> stopped{false};
        std::atomic<int> done{0};
        std::vector<ScheduledRun> runs(5);
        for (std::size_t r = 1; r < runs.size(); ++r)
            runs[r].after = {r - 1};
        run_side_by_side(
            runs, jobs, [&] { return stopped.load(); },
            [&](std::size_t run, int) {
                ++done;
                stopped = run == 2;
            });
        EXPECT_EQ(done, 3);
    }
}

TEST(RunSchedule, AnErrorIsThrownAfterAllRunsHaveEnded) {
    for (const int jobs : {1, 3}) {
        std::atomic<int> going{0}, begun{0};
        std::vector<ScheduledRun> runs(6);
        EXPECT_THROW(run_side_by_side(runs, jobs, never,
                                      [&](std::size_t run, int) {
                                          ++going;
                                          ++begun;
                                          std::this_thread::sleep_for(std::chrono::milliseconds(run == 1 ? 1 : 20));
                                          --going;
                                          if (run == 1)
                                              throw std::runtime_error("broken");
                                      }),
                     std::runtime_error);
        EXPECT_EQ(going, 0);
        EXPECT_LT(begun, 6);
    }
}

} // namespace graze::run_schedule_test
