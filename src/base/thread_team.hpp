#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace graze {

/// Threads that do one computation together, the calling one among them.
class ThreadTeam {
public:
    /// Does the work on so many threads, or on fewer where the system gives no more of them.
    /// @param work given whether it is the calling thread; it ends when the team is stopped
    /// @throws what the first one throws that does, after all have ended
    template <class Work>
    void run(std::size_t threads, const Work& work) {
        {
            std::vector<std::jthread> others;
            others.reserve(threads);
            try {
                while (others.size() + 1 < threads)
                    others.emplace_back([&] { attempt(work, false); });
            } catch (const std::system_error&) { // those that there are do all of it
            }
            attempt(work, true);
        }
        if (thrown_)
            std::rethrow_exception(thrown_);
    }
    /// Nothing new is begun from now on.
    void stop() { stopped_ = true; }
    bool is_stopped() const { return stopped_; }

private:
    template <class Work>
    void attempt(const Work& work, bool calling) {
        try {
            work(calling);
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!thrown_)
                thrown_ = std::current_exception();
            stop();
        }
    }

    std::atomic<bool> stopped_{false};
    std::mutex mutex_; ///< of what is thrown
    std::exception_ptr thrown_;
};

} // namespace graze
