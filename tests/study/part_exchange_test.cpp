#include "graze/study/part_exchange.hpp"

#include "base/message_of.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace graze::part_exchange_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Work of some items, which notes what it takes.
struct NotedWork {
    std::vector<std::string> taken{};
    PartedWork work{"text",
                    {{0, 3}, {5, 7}},
                    [](ItemRange items) { return std::to_string(items.first) + "-" + std::to_string(items.last); },
                    [this](ItemRange items, const std::string& piece, bool is_last) {
                        taken.push_back(std::to_string(items.first) + piece + (is_last ? "." : ""));
                    }};
};

/// Waits until work has opened.
PartExchange::Opened opened_in(PartExchange& exchange) {
    for (;;)
        if (auto opened = exchange.opened(); !opened.empty())
            return opened.front();
}

TEST(PartExchange, HandsOnWhatIsGiven) {
    PartExchange exchange;
    NotedWork noted;
    std::future<bool> waits = std::async(std::launch::async, [&] { return exchange.await(noted.work, {}); });
    const PartExchange::Opened opened = opened_in(exchange);
    EXPECT_TRUE(exchange.opened().empty());
    EXPECT_EQ(opened.text, "text");
    ASSERT_EQ(opened.missing.size(), 2U);
    EXPECT_EQ(exchange.part(opened.number, {5, 7}), "5-7");
    EXPECT_THROW(exchange.part(opened.number, {5, 8}), InputError);
    EXPECT_THROW(exchange.give(opened.number, {0, 6}, "all"), InputError);
    exchange.give_piece(opened.number, {5, 7}, "a");
    exchange.give(opened.number, {0, 3}, "b");
    EXPECT_TRUE(exchange.is_open(opened.number));
    exchange.give(opened.number, {5, 7}, "c");
    EXPECT_TRUE(waits.get());
    EXPECT_THAT(noted.taken, ElementsAre("5a", "0b.", "5c."));
    // Nobody waits any more.
    EXPECT_FALSE(exchange.is_open(opened.number));
    EXPECT_FALSE(exchange.part(opened.number, {5, 7}));
    exchange.give(opened.number, {5, 7}, "c");
    EXPECT_EQ(exchange.waiting(), 0U);
}

TEST(PartExchange, KeepsWhatHasComeBeforeAnInterruption) {
    PartExchange exchange;
    NotedWork noted;
    std::atomic<bool> is_interrupted = false;
    std::future<bool> waits = std::async(
        std::launch::async, [&] { return exchange.await(noted.work, [&] { return is_interrupted.load(); }); });
    const std::size_t number = opened_in(exchange).number;
    exchange.give(number, {0, 3}, "a");
    exchange.give_piece(number, {5, 7}, "b");
    is_interrupted = true;
    EXPECT_FALSE(waits.get());
    EXPECT_THAT(noted.taken, ElementsAre("0a.", "5b"));
}

TEST(PartExchange, LetsWorkFail) {
    PartExchange exchange;
    NotedWork noted;
    std::future<bool> waits = std::async(std::launch::async, [&] { return exchange.await(noted.work, {}); });
    const std::size_t number = opened_in(exchange).number;
    exchange.fail(number, std::make_exception_ptr(InputError("no room", "make some")));
    EXPECT_THAT(testing::message_of([&] { waits.get(); }), HasSubstr("no room; make some"));
    EXPECT_FALSE(exchange.is_open(number));
}

TEST(PartExchange, EndsTheWorkThatCannotTakeWhatIsGiven) {
    PartExchange exchange;
    NotedWork noted;
    noted.work.take = [](ItemRange, const std::string&, bool) { throw InputError("spoilt", ""); };
    std::future<bool> waits = std::async(std::launch::async, [&] { return exchange.await(noted.work, {}); });
    const std::size_t number = opened_in(exchange).number;
    exchange.give(number, {0, 3}, "a");
    EXPECT_THROW(waits.get(), InputError);
    EXPECT_FALSE(exchange.is_open(number));
}

TEST(PartExchange, DoesNotWaitForNothing) {
    PartExchange exchange;
    NotedWork noted;
    noted.work.missing.clear();
    EXPECT_TRUE(exchange.await(noted.work, {}));
}

} // namespace graze::part_exchange_test
