#include "base/thread_team.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace graze::thread_team_test {

TEST(ThreadTeam, WorksOnSoManyThreads) {
    for (const std::size_t threads : {1U, 4U}) {
        ThreadTeam team;
        std::atomic<std::size_t> calls{0}, calling{0};
        team.run(threads, [&](bool is_calling) {
            ++calls;
            calling += is_calling ? 1 : 0;
        });
        EXPECT_EQ(calls, threads);
        EXPECT_EQ(calling, 1U);
        EXPECT_FALSE(team.is_stopped());
    }
}

TEST(ThreadTeam, ThrowsTheFirstExceptionAfterAllHaveEnded) {
    ThreadTeam team;
    std::atomic<int> ended{0};
    EXPECT_THROW(team.run(4,
                          [&](bool calling) {
                              if (!calling && ended == 0)
                                  throw std::domain_error("of a thread");
                              while (!team.is_stopped())
                                  std::this_thread::yield();
                              ++ended;
                          }),
                 std::domain_error);
    EXPECT_TRUE(team.is_stopped());
    EXPECT_GE(ended, 1);
}

} // namespace graze::thread_team_test
