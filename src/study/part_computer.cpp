#include "graze/study/part_computer.hpp"

#include "graze/study/whole_run.hpp"
#include "study/dealt_messages.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace graze {

namespace {

using What = DealtMessage::What;
using Clock = std::chrono::steady_clock;

/// How long it takes at most until a message is seen. Who asks all the time leaves little of a core to others.
constexpr std::chrono::milliseconds between_looks{1};

/// Work of which parts are computed.
class ComputedWork {
public:
    ComputedWork(std::string text, const MakeExamination& examination)
        : text_(std::move(text)), examination_(&examination) {}

    /// @param sink receives pieces of the result. @return the rest of it; empty: it was interrupted
    std::string compute(const std::string& part, const PieceSink& sink) {
        return computation()(
            part, [this] { return is_forgotten.load(); }, sink);
    }

    std::atomic<bool> is_forgotten = false;

private:
    const PartComputation& computation() {
        const std::lock_guard lock(mutex_);
        if (!computation_)
            computation_ = computation_of(text_, *examination_);
        return computation_;
    }

    std::string text_;
    const MakeExamination* examination_;
    std::mutex mutex_;
    PartComputation computation_;
};

/// Computes tasks by threads of its own, while another thread exchanges messages.
class PartComputer {
public:
    PartComputer(Messages& messages, std::size_t threads, const MakeExamination& examination)
        : messages_(&messages), examination_(&examination) {
        for (std::size_t thread = 0; thread < threads; ++thread)
            threads_.emplace_back([this] { compute_all(); });
    }
    ~PartComputer() {
        {
            const std::lock_guard lock(mutex_);
            forget_all();
        }
        task_came_.notify_all();
    }

    /// Until it is told to end.
    void run() {
        while (receive())
            send(between_looks);
        {
            const std::lock_guard lock(mutex_);
            forget_all();
        }
        task_came_.notify_all();
        threads_.clear();
        send({});
        messages_->send(0, bytes_of({.what = What::bye}));
    }

private:
    struct Task {
        std::shared_ptr<ComputedWork> work;
        DealtMessage message;
    };

    void forget_all() {
        has_ended_ = true;
        for (const auto& [number, work] : works_)
            work->is_forgotten = true;
    }

    /// @return false: nothing more will come
    bool receive() {
        while (auto received = messages_->receive()) {
            DealtMessage message = message_of(received->bytes);
            const std::lock_guard lock(mutex_);
            if (message.what == What::work) {
                works_[message.work] = std::make_shared<ComputedWork>(std::move(message.bytes), *examination_);
            } else if (message.what == What::task) {
                tasks_.push_back({works_.at(message.work), std::move(message)});
                task_came_.notify_one();
            } else if (message.what == What::forget) {
                works_.at(message.work)->is_forgotten = true;
                works_.erase(message.work);
            } else if (message.what == What::end) {
                return false;
            }
        }
        return true;
    }

    /// Sends what has been computed, once there is something or the time is over.
    void send(std::chrono::milliseconds patience) {
        std::unique_lock lock(mutex_);
        result_came_.wait_for(lock, patience, [this] { return !outgoing_.empty(); });
        const std::deque<DealtMessage> outgoing = std::exchange(outgoing_, {});
        lock.unlock();
        for (const DealtMessage& message : outgoing)
            messages_->send(0, bytes_of(message));
    }

    void compute_all() {
        std::unique_lock lock(mutex_);
        for (;;) {
            task_came_.wait(lock, [this] { return has_ended_ || !tasks_.empty(); });
            if (tasks_.empty())
                return;
            const Task task = std::move(tasks_.front());
            tasks_.pop_front();
            lock.unlock();
            DealtMessage result = computed(task);
            lock.lock();
            outgoing_.push_back(std::move(result));
            result_came_.notify_one();
        }
    }

    DealtMessage computed(const Task& task) {
        DealtMessage result{What::result, task.message.work, task.message.items, 0, {}};
        const PieceSink send_piece = [&](std::string piece) {
            const std::lock_guard lock(mutex_);
            outgoing_.push_back({What::piece, result.work, result.items, 0, std::move(piece)});
            result_came_.notify_one();
        };
        try {
            const Clock::time_point begun = Clock::now();
            if (!task.work->is_forgotten)
                result.bytes = task.work->compute(task.message.bytes, send_piece);
            result.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
            if (result.bytes.empty())
                result.what = What::left;
        } catch (...) {
            result.what = What::failed;
            result.bytes = bytes_of(std::current_exception());
        }
        return result;
    }

    Messages* messages_;
    const MakeExamination* examination_;
    std::mutex mutex_;
    std::condition_variable task_came_, result_came_;
    std::map<std::size_t, std::shared_ptr<ComputedWork>> works_;
    std::deque<Task> tasks_;
    std::deque<DealtMessage> outgoing_;
    bool has_ended_ = false;
    std::vector<std::jthread> threads_; ///< the last member: they use the others until they are joined
};

} // namespace

PartComputation computation_of(const std::string& text, const MakeExamination& examination) {
    if (is_whole_run(text))
        return [text](const std::string& part, const std::function<bool()>& interrupted, const PieceSink&) {
            return computed_run(text, part, interrupted);
        };
    if (is_device_solver(text))
        return [solver = std::make_shared<const DeviceSolver>(device_solver_of(text, examination))](
                   const std::string& part, const std::function<bool()>& interrupted, const PieceSink&) {
            return solved_part(*solver, part, interrupted);
        };
    return [run = std::make_shared<const PartedRun>(text)](
               const std::string& part, const std::function<bool()>& interrupted, const PieceSink& sink) {
        return computed_points(*run, part_of(part), interrupted, sink);
    };
}

void compute_parts(Messages& messages, std::size_t threads, const MakeExamination& examination) {
    PartComputer(messages, threads, examination).run();
}

} // namespace graze
