#include "python/attended.hpp"

#include "python/binding.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <pthread.h>
#include <thread>

namespace graze::python {

namespace {

constexpr std::chrono::milliseconds between_checks{20};

/// The work of all threads. It is never destroyed; a process that was forked begins with another one, since it has only
/// the thread that has forked.
struct AllWork {
    std::mutex mutex;
    std::condition_variable changed;
    int running = 0;
    std::atomic<bool> ending = false;
    std::thread::id ended_by; ///< the thread that ends the process
};

std::atomic<AllWork*> all_of_process = nullptr;

void begin_process() {
    all_of_process = new AllWork; // NOLINT(cppcoreguidelines-owning-memory): threads may outlive statics
}

AllWork& all_work() {
    return *all_of_process;
}

/// The work in its own thread, which ends before this does.
class Work {
public:
    Work(const std::function<void(const std::function<bool()>&)>& work, const std::atomic<bool>& stop)
        : thread_([this, &work, &stop] {
              std::exception_ptr thrown;
              try {
                  const RunningWork running;
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
        return changed_.wait_for(lock, between_checks, [this] { return ended_; });
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

bool interpreter_is_ending() {
#if PY_VERSION_HEX >= 0x030d0000
    return Py_IsFinalizing() != 0;
#else
    return _Py_IsFinalizing() != 0;
#endif
}

/// Whether this thread ends the process: it keeps the interpreter's lock to the last.
bool ends_process() {
    return all_work().ending && std::this_thread::get_id() == all_work().ended_by;
}

void lock_again(PyThreadState* state) {
    while ((interpreter_is_ending() && !ends_process()) || process_is_ending())
        std::this_thread::sleep_for(std::chrono::hours(1));
    PyEval_RestoreThread(state);
}

} // namespace

RunningWork::RunningWork() {
    const std::lock_guard lock(all_work().mutex);
    ++all_work().running;
}

RunningWork::~RunningWork() {
    const std::lock_guard lock(all_work().mutex);
    --all_work().running;
    all_work().changed.notify_all();
}

bool process_is_ending() {
    return all_work().ending && std::this_thread::get_id() != all_work().ended_by;
}

void stop_work_at_exit() {
    begin_process();
    pthread_atfork(nullptr, nullptr, &begin_process);
    py::module_::import("atexit").attr("register")(py::cpp_function([] {
        constexpr std::chrono::seconds longest{10};
        const py::gil_scoped_release unlocked;
        std::unique_lock lock(all_work().mutex);
        all_work().ended_by = std::this_thread::get_id();
        all_work().ending = true;
        all_work().changed.wait_for(lock, longest, [] { return all_work().running <= 0; });
    }));
}

Unlocked::Unlocked() : state_(PyEval_SaveThread()) {}

Unlocked::~Unlocked() {
    lock_again(state_);
}

void Unlocked::locked(const std::function<void()>& something) {
    lock_again(state_);
    try {
        something();
    } catch (...) {
        PyEval_SaveThread();
        throw;
    }
    PyEval_SaveThread();
}

void handle_signals() {
    if (PyErr_CheckSignals() != 0)
        throw py::error_already_set();
}

void attended(const std::function<void(const std::function<bool()>&)>& work, const std::function<void()>& told) {
    std::atomic<bool> stop = false;
    std::exception_ptr raised;
    {
        Unlocked unlocked;
        Work going(work, stop);
        while (!going.wait()) {
            if (raised)
                continue;
            if (process_is_ending()) {
                stop = true;
                continue;
            }
            unlocked.locked([&] {
                try {
                    handle_signals();
                    if (told)
                        told();
                } catch (...) {
                    raised = std::current_exception();
                    stop = true;
                }
            });
        }
        if (!raised)
            going.rethrow();
    }
    if (raised)
        std::rethrow_exception(raised);
}

} // namespace graze::python
