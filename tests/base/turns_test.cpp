#include "base/turns.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

namespace graze::turns_test {

TEST(Turns, AreTakenByOneThreadAtATime) {
    const Turns turns;
    std::atomic<int> inside{0}, together{0};
    int count = 0;
    const auto enter = [&] {
        together += inside++ > 0 ? 1 : 0;
        ++count;
        --inside;
    };
    const std::function<void(int)> tell = turns.taking(std::function<void(int)>([&](int) { enter(); }));
    const std::function<bool()> ask = turns.asking([&] {
        enter();
        return false;
    });
    {
        std::vector<std::jthread> threads;
        for (int i = 0; i < 4; ++i)
            threads.emplace_back([&] {
                for (int k = 0; k < 1000; ++k) {
                    tell(k);
                    EXPECT_FALSE(ask());
                }
            });
    }
    EXPECT_EQ(together, 0);
    EXPECT_GE(count, 4000);
    EXPECT_LE(count, 8000);
}

TEST(Turns, NobodyWaitsToAsk) {
    const Turns turns;
    const std::function<bool()> ask = turns.asking([] { return true; });
    turns.in_turn([&] { std::jthread([&] { EXPECT_FALSE(ask()); }); });
    EXPECT_TRUE(ask());
}

TEST(Turns, AnAnswerToStopHoldsWhileAnotherCallbackRuns) {
    const Turns turns;
    const std::function<bool()> ask = turns.asking([] { return true; });
    EXPECT_TRUE(ask());
    turns.in_turn([&] { std::jthread([&] { EXPECT_TRUE(ask()); }); });
}

TEST(Turns, EndWithTheFirstException) {
    const Turns turns;
    int told = 0;
    const std::function<void()> tell = turns.taking(std::function<void()>([&] { ++told; }));
    tell();
    EXPECT_NO_THROW(turns.rethrow());
    EXPECT_THROW(turns.in_turn([] { throw std::domain_error("mine"); }), std::domain_error);
    EXPECT_THROW(turns.rethrow(), std::domain_error);
    EXPECT_THROW(tell(), std::domain_error);
    EXPECT_THROW(turns.asking([] { return false; })(), std::domain_error);
    EXPECT_EQ(told, 1);
}

TEST(Turns, OfNothingAreNothing) {
    EXPECT_FALSE(Turns().taking(std::function<void()>()));
    EXPECT_FALSE(Turns().asking({}));
}

} // namespace graze::turns_test
