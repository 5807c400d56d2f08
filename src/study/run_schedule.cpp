#include "study/run_schedule.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>

namespace graze {

namespace {

class Schedule {
public:
    Schedule(const std::vector<ScheduledRun>& runs, int jobs, const std::function<bool()>& stopped,
             const std::function<void(std::size_t, int)>& work)
        : runs_(runs), jobs_(static_cast<std::size_t>(jobs)), stopped_(stopped), work_(work), states_(runs.size()) {}

    void run() {
        std::unique_lock lock(mutex_);
        for (;;) {
            begin_what_can();
            if (going_ == 0)
                break;
            changed_.wait(lock);
        }
        lock.unlock();
        threads_.clear();
        if (error_)
            std::rethrow_exception(error_);
    }

private:
    enum class State { waiting, going, ended };

    bool may_begin(std::size_t run) const {
        const auto& after = runs_[run].after;
        return states_[run] == State::waiting && std::all_of(after.begin(), after.end(), [this](std::size_t one) {
                   return states_[one] == State::ended;
               });
    }
    std::size_t threads_for(std::size_t run) const { return std::clamp<std::size_t>(runs_[run].threads, 1, jobs_); }

    void begin_what_can() {
        for (std::size_t run = 0; run < runs_.size() && busy_ < jobs_; ++run) {
            if (!may_begin(run))
                continue;
            if (error_ || (stopped_ && stopped_()))
                return;
            states_[run] = State::going;
            ++going_;
            busy_ += threads_for(run);
            try {
                threads_.emplace_back([this, run] { work(run); });
            } catch (const std::system_error&) { // the system gives no more of them now
                states_[run] = State::waiting;
                --going_;
                busy_ -= threads_for(run);
                if (going_ == 0)
                    throw;
                return;
            }
        }
    }
    void work(std::size_t run) {
        std::exception_ptr error;
        try {
            work_(run, static_cast<int>(threads_for(run)));
        } catch (...) {
            error = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        if (!error_)
            error_ = error;
        states_[run] = State::ended;
        --going_;
        busy_ -= threads_for(run);
        changed_.notify_one();
    }

    const std::vector<ScheduledRun>& runs_;
    std::size_t jobs_;
    const std::function<bool()>& stopped_;
    const std::function<void(std::size_t, int)>& work_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<State> states_;
    std::size_t going_ = 0, busy_ = 0; ///< runs, and their threads
    std::exception_ptr error_;
    std::vector<std::jthread> threads_; ///< the last member: they use the others until they are joined
};

} // namespace

void run_side_by_side(const std::vector<ScheduledRun>& runs, int jobs, const std::function<bool()>& stopped,
                      const std::function<void(std::size_t run, int threads)>& work) {
    if (jobs > 1 && runs.size() > 1)
        return Schedule(runs, jobs, stopped, work).run();
    for (std::size_t run = 0; run < runs.size() && !(stopped && stopped()); ++run)
        work(run, jobs);
}

} // namespace graze
