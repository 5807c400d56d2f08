#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

namespace graze {

/// Lets the callbacks of one computation be called by one of its threads at a time, and none of them once one has
/// thrown: whoever calls one then gets that exception. Copies are handles of the same.
class Turns {
public:
    /// Does something while no callback is being called.
    template <class Work>
    auto in_turn(const Work& work) const -> decltype(work()) {
        const std::lock_guard lock(state_->mutex);
        return attempt(work);
    }
    /// The same callback, which waits for its turn; none where there is none.
    template <class Result, class... Arguments>
    std::function<Result(Arguments...)> taking(std::function<Result(Arguments...)> callback) const {
        if (!callback)
            return {};
        return [turns = *this, callback = std::move(callback)](Arguments... arguments) -> Result {
            return turns.in_turn([&] { return callback(std::forward<Arguments>(arguments)...); });
        };
    }
    /// The same question whether to stop. Nobody waits to ask it: while another callback is being called the answer is
    /// no, unless it has been yes before.
    std::function<bool()> asking(std::function<bool()> interrupted) const {
        if (!interrupted)
            return {};
        return [turns = *this, interrupted = std::move(interrupted)] {
            if (turns.state_->is_stopped)
                return true;
            const std::unique_lock lock(turns.state_->mutex, std::try_to_lock);
            if (lock.owns_lock() && turns.attempt(interrupted))
                turns.state_->is_stopped = true;
            return turns.state_->is_stopped.load();
        };
    }
    /// Throws what one has thrown, if any has.
    void rethrow() const {
        const std::lock_guard lock(state_->mutex);
        if (state_->thrown)
            std::rethrow_exception(state_->thrown);
    }

private:
    template <class Work>
    auto attempt(const Work& work) const -> decltype(work()) {
        if (state_->thrown)
            std::rethrow_exception(state_->thrown);
        try {
            return work();
        } catch (...) {
            state_->thrown = std::current_exception();
            throw;
        }
    }

    struct State {
        std::mutex mutex{};
        std::exception_ptr thrown{};
        std::atomic<bool> is_stopped{false};
    };
    std::shared_ptr<State> state_ = std::make_shared<State>();
};

} // namespace graze
