#include "page/job_queue.hpp"

#include "page/error_answer.hpp"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace graze {
namespace {

/// Jobs that run until they are told to end, with all that is told of them.
class TestedQueue {
public:
    explicit TestedQueue(std::size_t most_waiting = 8)
        : queue_([this](const std::vector<std::string>& runs,
                        const JobControl& control) { return compute(runs, control); },
                 [this](const Job& job) { note(job); }, most_waiting, std::chrono::milliseconds(0)) {}

    JobQueue& operator*() { return queue_; }
    JobQueue* operator->() { return &queue_; }
    void let_end() { may_end_ = true; }

    /// Waits until a job has this state. @return what was told of it
    Job wait_for(std::size_t id, JobState state) {
        std::unique_lock lock(mutex_);
        Job found;
        changed_.wait_for(lock, std::chrono::seconds(20), [&] {
            for (const Job& job : told_)
                if (job.id == id && job.state == state)
                    found = job;
            return found.id != 0;
        });
        return found;
    }
    /// Waits until a job tells how far it is.
    Job wait_for_progress(std::size_t id) {
        std::unique_lock lock(mutex_);
        Job found;
        changed_.wait_for(lock, std::chrono::seconds(20), [&] {
            for (const Job& job : told_)
                if (job.id == id && job.done > 0)
                    found = job;
            return found.id != 0;
        });
        return found;
    }

private:
    JobEnd compute(const std::vector<std::string>& runs, const JobControl& control) {
        if (runs.front() == "wrong")
            throw std::runtime_error("it is wrong");
        if (runs.front() == "failing")
            return {false, "it fails"};
        control.progress(runs.front(), 3, 5);
        while (!may_end_ && !control.interrupted())
            std::this_thread::yield();
        return {!may_end_, ""};
    }
    void note(const Job& job) {
        {
            const std::lock_guard lock(mutex_);
            told_.push_back(job);
        }
        changed_.notify_all();
    }

    std::atomic<bool> may_end_ = false;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Job> told_;
    JobQueue queue_; ///< the last member: its thread uses the others
};

TEST(JobQueue, ComputesOneAfterTheOther) {
    TestedQueue queue;
    const Job first = queue->add({"a"}), second = queue->add({"b", "c"});
    EXPECT_EQ(first.state, JobState::waiting);
    EXPECT_NE(first.id, second.id);
    const Job running = queue.wait_for_progress(first.id);
    EXPECT_EQ(running.run, "a");
    EXPECT_EQ(running.done, 3U);
    EXPECT_EQ(running.points, 5U);
    EXPECT_EQ(queue->jobs().back().state, JobState::waiting);
    EXPECT_TRUE(queue->is_busy());
    queue.let_end();
    EXPECT_EQ(queue.wait_for(first.id, JobState::complete).id, first.id);
    EXPECT_EQ(queue.wait_for(second.id, JobState::complete).runs, (std::vector<std::string>{"b", "c"}));
    EXPECT_FALSE(queue->is_busy());
}

TEST(JobQueue, StopsAJobThatRunsAndOneThatWaits) {
    TestedQueue queue;
    const Job first = queue->add({"a"}), second = queue->add({"b"});
    queue.wait_for_progress(first.id);
    EXPECT_EQ(queue->stop(second.id)->state, JobState::stopped);
    EXPECT_EQ(queue->stop(first.id)->state, JobState::running);
    EXPECT_EQ(queue.wait_for(first.id, JobState::stopped).id, first.id);
    EXPECT_EQ(queue->stop(first.id)->state, JobState::stopped);
    EXPECT_FALSE(queue->stop(77));
    // The next one is not stopped with it.
    const Job third = queue->add({"c"});
    queue.wait_for_progress(third.id);
    queue.let_end();
    EXPECT_EQ(queue.wait_for(third.id, JobState::complete).id, third.id);
}

TEST(JobQueue, TellsWhyAJobFails) {
    TestedQueue queue;
    EXPECT_EQ(queue.wait_for(queue->add({"wrong"}).id, JobState::failed).message, "it is wrong");
    EXPECT_EQ(queue.wait_for(queue->add({"failing"}).id, JobState::failed).message, "it fails");
}

TEST(JobQueue, LetsOnlySoManyWait) {
    TestedQueue queue(2);
    const Job first = queue->add({"a"});
    queue.wait_for_progress(first.id);
    queue->add({"b"});
    queue->add({"c"});
    EXPECT_THROW(queue->require_room(), RefusedRequest);
    EXPECT_THROW(queue->add({"d"}), RefusedRequest);
    queue->stop(queue->jobs().back().id);
    EXPECT_NO_THROW(queue->add({"d"}));
}

TEST(JobQueue, EndsWhileAJobRuns) {
    TestedQueue queue;
    const Job first = queue->add({"a"}), second = queue->add({"b"});
    queue.wait_for_progress(first.id);
    queue->stop_all();
    EXPECT_EQ(queue->jobs().front().state, JobState::stopped);
    EXPECT_EQ(queue->jobs().back().state, JobState::stopped);
    EXPECT_THROW(queue->add({"c"}), RefusedRequest);
}

TEST(JobQueue, ForgetsJobsThatEndedLongAgo) {
    TestedQueue queue;
    queue.let_end();
    std::size_t last = 0;
    for (int i = 0; i < 150; ++i)
        queue.wait_for(last = queue->add({"a"}).id, JobState::complete);
    EXPECT_LE(queue->jobs().size(), 102U);
    EXPECT_EQ(queue->jobs().back().id, last);
}

TEST(JobJson, HasNullForAnUnknownNumberOfPoints) {
    Job job;
    job.id = 4;
    job.runs = {"a"};
    EXPECT_EQ(job_json(job),
              nlohmann::json::parse(
                  R"({"id":4,"runs":["a"],"state":"waiting","run":"","done":0,"points":null,"message":""})"));
    job.points = 7;
    EXPECT_EQ(job_json(job)["points"], 7);
}

} // namespace
} // namespace graze
