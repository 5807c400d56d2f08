#include "page/job_queue.hpp"

#include "base/enumerator_name.hpp"
#include "graze/base/printable.hpp"
#include "page/error_answer.hpp"

#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr std::size_t most_ended_jobs = 100; ///< that are remembered

std::string_view name_of(JobState state) {
    constexpr std::string_view names[] = {"waiting", "running", "complete", "stopped", "failed"};
    return enumerator_name(names, state, "failed");
}

bool has_ended(const Job& job) {
    return job.state != JobState::waiting && job.state != JobState::running;
}

} // namespace

nlohmann::json job_json(const Job& job) {
    return {{"id", job.id},
            {"runs", job.runs},
            {"state", name_of(job.state)},
            {"run", job.run},
            {"done", job.done},
            {"points", job.points ? nlohmann::json(*job.points) : nlohmann::json()},
            {"message", job.message}};
}

JobQueue::JobQueue(Compute compute, Changed changed, std::size_t most_waiting,
                   std::chrono::milliseconds between_reports)
    : compute_(std::move(compute)), changed_(std::move(changed)), most_waiting_(most_waiting),
      between_reports_(between_reports), thread_([this] { work(); }) {}

JobQueue::~JobQueue() {
    stop_all();
}

Job* JobQueue::find(std::size_t id) {
    const auto found = std::ranges::find(jobs_, id, &Job::id);
    return found == jobs_.end() ? nullptr : &*found;
}

void JobQueue::require_room() const {
    const std::lock_guard lock(mutex_);
    if (ended_)
        throw RefusedRequest(503, "the server ends", "start it again");
    if (static_cast<std::size_t>(std::ranges::count(jobs_, JobState::waiting, &Job::state)) >= most_waiting_)
        throw RefusedRequest(429, fmt::format("{} jobs are waiting already", most_waiting_),
                             "wait until one has ended, or stop one");
}

Job JobQueue::add(const std::vector<std::string>& runs) {
    require_room();
    Job job;
    {
        const std::lock_guard lock(mutex_);
        job.id = ++last_id_;
        job.runs = runs;
        jobs_.push_back(job);
        auto ended = std::ranges::count_if(jobs_, has_ended);
        std::erase_if(jobs_, [&](const Job& one) {
            return has_ended(one) && ended-- > static_cast<std::ptrdiff_t>(most_ended_jobs);
        });
    }
    awaited_.notify_one();
    return job;
}

std::optional<Job> JobQueue::stop(std::size_t id) {
    const std::lock_guard lock(mutex_);
    Job* job = find(id);
    if (job == nullptr)
        return std::nullopt;
    if (job->state == JobState::waiting)
        job->state = JobState::stopped;
    else if (job->state == JobState::running)
        stop_running_ = true;
    return *job;
}

std::vector<Job> JobQueue::jobs() const {
    const std::lock_guard lock(mutex_);
    return {jobs_.begin(), jobs_.end()};
}

bool JobQueue::is_busy() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(jobs_, [](const Job& job) { return !has_ended(job); });
}

void JobQueue::stop_all() {
    {
        const std::lock_guard lock(mutex_);
        ended_ = stop_running_ = true;
        for (Job& job : jobs_)
            if (job.state == JobState::waiting)
                job.state = JobState::stopped;
    }
    awaited_.notify_one();
    if (thread_.joinable())
        thread_.join();
}

void JobQueue::report(std::size_t id, const std::string& run, std::size_t done, std::optional<std::size_t> points) {
    Job job;
    {
        const std::lock_guard lock(mutex_);
        Job* one = find(id);
        one->run = run;
        one->done = done;
        one->points = points;
        job = *one;
    }
    const auto now = std::chrono::steady_clock::now();
    if (now - reported_ < between_reports_)
        return;
    reported_ = now;
    changed_(job);
}

JobEnd JobQueue::compute(const std::vector<std::string>& runs, std::size_t id) {
    JobControl control;
    control.interrupted = [this] {
        const std::lock_guard lock(mutex_);
        return stop_running_;
    };
    control.progress = [this, id](const std::string& run, std::size_t done, std::optional<std::size_t> points) {
        report(id, run, done, points);
    };
    try {
        return compute_(runs, control);
    } catch (const std::exception& error) {
        return {false, printable_line(error.what())};
    }
}

void JobQueue::work() {
    for (;;) {
        Job job;
        {
            std::unique_lock lock(mutex_);
            const auto waits = [](const Job& one) { return one.state == JobState::waiting; };
            awaited_.wait(lock, [&] { return ended_ || std::ranges::any_of(jobs_, waits); });
            if (ended_)
                return;
            Job& next = *std::ranges::find_if(jobs_, waits);
            next.state = JobState::running;
            stop_running_ = false;
            job = next;
        }
        changed_(job);
        const JobEnd end = compute(job.runs, job.id);
        {
            const std::lock_guard lock(mutex_);
            Job& one = *find(job.id);
            one.message = end.failure;
            one.state = !end.failure.empty() ? JobState::failed
                        : end.interrupted    ? JobState::stopped
                                             : JobState::complete;
            job = one;
        }
        changed_(job);
    }
}

} // namespace graze
