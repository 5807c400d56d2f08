#include "graze/study/part_dealer.hpp"

#include "base/message_of.hpp"
#include "messages_in_threads.hpp"
#include "study/dealt_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <map>
#include <new>

namespace graze::part_dealer_test {

using ::testing::HasSubstr;
using What = DealtMessage::What;

/// A dealer whose workers do nothing of themselves.
class PartDealerTest : public ::testing::Test {
protected:
    /// Opens work of so many items.
    std::future<bool> open(const std::string& text, std::size_t items) {
        PartedWork work{
            text, {{0, items}}, [](ItemRange) { return "part"; }, [](ItemRange, const std::string&, bool) {}};
        auto waits = std::async(std::launch::async, [this, work] {
            return exchange_.await(work, [this] { return is_interrupted_.load(); });
        });
        while (!exchange_.is_open(opened_))
            std::this_thread::yield();
        ++opened_;
        return waits;
    }
    /// Lets the dealer look, and notes what comes to the workers.
    void look() {
        dealer_.look();
        for (std::size_t worker : {1, 2})
            while (const auto message = workers_[worker - 1]->receive()) {
                const DealtMessage came = message_of(message->bytes);
                if (came.what == What::task)
                    tasks_[worker].push_back(came);
                else
                    ++came_[worker][came.what];
            }
    }
    /// A worker has done its first task.
    void finish(std::size_t worker, double seconds, What what = What::result) {
        DealtMessage done = tasks_[worker].front();
        tasks_[worker].erase(tasks_[worker].begin());
        done.what = what;
        done.seconds = seconds;
        done.bytes = what == What::failed ? bytes_of(std::make_exception_ptr(InputError("wrong", "mend it"))) : "done";
        workers_[worker - 1]->send(0, bytes_of(done));
    }

    testing::Mail mail_{3};
    std::unique_ptr<Messages> own_ = mail_.of(0), workers_[2] = {mail_.of(1), mail_.of(2)};
    PartExchange exchange_;
    PartDealer dealer_{*own_, exchange_, 1};
    std::size_t opened_ = 0;
    std::atomic<bool> is_interrupted_ = false;
    std::map<std::size_t, std::vector<DealtMessage>> tasks_;
    std::map<std::size_t, std::map<What, int>> came_;
};

TEST_F(PartDealerTest, LetsTasksWaitOnlyWhereTheyAreBrief) {
    std::future<bool> waits = open("work", 1000000);
    look();
    EXPECT_EQ(tasks_[1].size(), 1U); // it may take minutes
    EXPECT_EQ(tasks_[2].size(), 1U);
    EXPECT_EQ(came_[1][What::work], 1);
    finish(1, 10);
    look();
    EXPECT_EQ(tasks_[1].size(), 1U);
    finish(1, 1e-3);
    finish(2, 1e-3);
    look();
    for (int result = 0; result < 40 && tasks_[1].size() == 1; ++result) {
        finish(1, 1e-3);
        look();
    }
    EXPECT_EQ(tasks_[1].size(), 2U);
    EXPECT_EQ(tasks_[2].size(), 2U);
    EXPECT_EQ(came_[1][What::work], 1); // the text is sent once
    is_interrupted_ = true;
    EXPECT_FALSE(waits.get());
    look();
    EXPECT_EQ(came_[1][What::forget], 1);
    EXPECT_EQ(came_[2][What::forget], 1);
}

TEST_F(PartDealerTest, BeginsWithWholeRuns) {
    std::future<bool> first = open("work", 1000);
    look();
    std::future<bool> second = open("graze-run-1\nrun", 1);
    look();
    EXPECT_EQ(tasks_[1].size() + tasks_[2].size(), 2U);
    finish(1, 1e-3);
    look();
    is_interrupted_ = true;
    ASSERT_FALSE(tasks_[1].empty());
    EXPECT_EQ(tasks_[1].front().work, 1U);
    first.get();
    second.get();
}

TEST_F(PartDealerTest, LetsWorkFailWithTheErrorOfAWorker) {
    std::future<bool> waits = open("work", 10);
    look();
    finish(1, 0, What::failed);
    look();
    EXPECT_THAT(testing::message_of([&] { waits.get(); }), HasSubstr("wrong; mend it"));
    look();
    ASSERT_FALSE(tasks_[2].empty());
    const std::size_t before = tasks_[1].size() + tasks_[2].size();
    finish(2, 1); // what comes later is not wanted
    look();
    EXPECT_EQ(tasks_[1].size() + tasks_[2].size(), before - 1);
}

TEST(DealtMessages, CarryErrors) {
    const auto carried = [](const std::exception_ptr& error) { std::rethrow_exception(error_of(bytes_of(error))); };
    try {
        carried(std::make_exception_ptr(InputError(Place{"file", 3, 4}, "problem", "remedy")));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "file:3:4: problem; remedy");
    }
    EXPECT_THROW(carried(std::make_exception_ptr(std::bad_alloc())), std::bad_alloc);
    try {
        carried(std::make_exception_ptr(std::runtime_error("other")));
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "other");
    }
}

TEST(DealtMessages, AreRefusedWhereTheyAreSpoilt) {
    const std::string bytes = bytes_of(DealtMessage{What::result, 1, {2, 3}, 4, "text"});
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THROW(message_of(std::string_view(bytes).substr(0, size)), InputError) << size;
    EXPECT_THROW(message_of(bytes + "x"), InputError);
}

} // namespace graze::part_dealer_test
