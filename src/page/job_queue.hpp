#pragma once

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace graze {

enum class JobState { waiting, running, complete, stopped, failed };

/// Runs of a study that are computed together.
struct Job {
    std::size_t id = 0;
    std::vector<std::string> runs;
    JobState state = JobState::waiting;
    std::string run{};                   ///< of which a point has just been computed
    std::size_t done = 0;                ///< points of that run
    std::optional<std::size_t> points{}; ///< planned ones; none: it is not known how many there will be
    std::string message{};               ///< why it failed
};

nlohmann::json job_json(const Job& job);

/// How a job that is being computed is told to stop, and tells how far it is.
struct JobControl {
    std::function<bool()> interrupted;
    std::function<void(const std::string& run, std::size_t done, std::optional<std::size_t> points)> progress;
};

/// How a job has ended.
struct JobEnd {
    bool interrupted = false;
    std::string failure{}; ///< empty: it has not failed
};

/// Computes jobs one after the other in a thread of its own, since only one may write to a result file.
class JobQueue {
public:
    /// Computes runs. What it throws counts as failure.
    using Compute = std::function<JobEnd(const std::vector<std::string>& runs, const JobControl& control)>;
    using Changed = std::function<void(const Job& job)>;

    /// @param changed called when a job changes, and not too often while it progresses, one call at a time
    JobQueue(Compute compute, Changed changed, std::size_t most_waiting = 8,
             std::chrono::milliseconds between_reports = std::chrono::milliseconds(100));
    ~JobQueue(); ///< stops
    JobQueue(const JobQueue&) = delete;
    JobQueue& operator=(const JobQueue&) = delete;

    /// @throws RefusedRequest when too many wait already
    void require_room() const;
    /// @return the job with its number @throws RefusedRequest as require_room
    Job add(const std::vector<std::string>& runs);
    /// Stops a job, whether it waits or runs; one that has ended stays as it is. @return none: there is no such job
    std::optional<Job> stop(std::size_t id);
    /// All jobs that wait or run, and the last ones that have ended, in the order of their numbers.
    std::vector<Job> jobs() const;
    bool is_busy() const;
    /// Interrupts the job that runs, and takes no more. Returns when it has ended.
    void stop_all();

private:
    void work();
    JobEnd compute(const std::vector<std::string>& runs, std::size_t id);
    void report(std::size_t id, const std::string& run, std::size_t done, std::optional<std::size_t> points);
    Job* find(std::size_t id);

    Compute compute_;
    Changed changed_;
    std::size_t most_waiting_;
    std::chrono::milliseconds between_reports_;
    std::chrono::steady_clock::time_point reported_{}; ///< used while a job progresses
    mutable std::mutex mutex_;
    std::condition_variable awaited_;
    std::deque<Job> jobs_;
    std::size_t last_id_ = 0;
    bool stop_running_ = false, ended_ = false;
    std::thread thread_;
};

} // namespace graze
