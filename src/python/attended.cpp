#include "python/attended.hpp"

#include "python/binding.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace graze::python {

namespace {

constexpr std::chrono::milliseconds between_looks{20};

/// The work in its own thread, which ends before this does.
class Work {
public:
    Work(const std::function<void(const std::function<bool()>&)>& work, const std::atomic<bool>& stop)
        : thread_([this, &work, &stop] {
              std::exception_ptr thrown;
              try {
                  work([&stop] { return stop.load(std::memory_order_relaxed); });
              } catch (...) {
                  thrown = std::current_exception();
              }
              const std::lock_guard lock(mutex_);
              thrown_ = thrown;
              ended_ = true;
              changed_.notify_all();
          }) {}

    /// @return whether it has ended
    bool wait() {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, between_looks, [this] { return ended_; });
    }
    /// To be called when it has ended.
    void rethrow() const {
        if (thrown_)
            std::rethrow_exception(thrown_);
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool ended_ = false;
    std::exception_ptr thrown_;
    std::jthread thread_; ///< the last member, since it uses the others
};

} // namespace

void attended(const std::function<void(const std::function<bool()>&)>& work, const std::function<void()>& told) {
    std::atomic<bool> stop = false;
    std::exception_ptr raised;
    {
        const py::gil_scoped_release unlocked;
        Work going(work, stop);
        while (!going.wait()) {
            if (raised)
                continue;
            const py::gil_scoped_acquire locked;
            try {
                if (PyErr_CheckSignals() != 0)
                    throw py::error_already_set();
                if (told)
                    told();
            } catch (...) {
                raised = std::current_exception();
                stop = true;
            }
        }
        if (!raised)
            going.rethrow();
    }
    if (raised)
        std::rethrow_exception(raised);
}

} // namespace graze::python
