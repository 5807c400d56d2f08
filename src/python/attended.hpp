#pragma once

#include <functional>

using PyThreadState = struct _ts; // NOLINT(bugprone-reserved-identifier): Python's own name

namespace graze::python {

/// While it exists, something is computed that the end of the process stops and waits for: it would take away what the
/// computation uses.
class RunningWork {
public:
    RunningWork();
    ~RunningWork();
    RunningWork(const RunningWork&) = delete;
    RunningWork& operator=(const RunningWork&) = delete;
};

/// Whether the process is ending, so that work of this thread has to stop. The thread that ends it may go on.
bool process_is_ending();

/// Stops all work when the interpreter ends. To be called once, with the interpreter's lock.
void stop_work_at_exit();

/// While it exists, the interpreter's lock is released. When the process is ending, the thread that wants the lock back
/// sleeps until it has ended: Python would end the thread, which C++ cannot survive.
class Unlocked {
public:
    Unlocked();
    ~Unlocked();
    Unlocked(const Unlocked&) = delete;
    Unlocked& operator=(const Unlocked&) = delete;

    /// Does something with the lock, in the thread that has released it.
    void locked(const std::function<void()>& something);

private:
    PyThreadState* state_;
};

/// Calls Python's handlers of signals, such as Ctrl-C, which run in the main thread only. With the interpreter's lock.
/// @throws what they raise, as KeyboardInterrupt
void handle_signals();

/// Says whether work has to stop; may be called from any thread.
using MustStop = std::function<bool()>;

/// Does work in a thread of its own, without the interpreter's lock, while the calling thread, which holds the lock,
/// looks for signals such as Ctrl-C some fifty times a second and calls `told`.
/// @param told is called with the lock; may be empty. What it throws stops the work
/// @throws what `told`, a handler of signals (as KeyboardInterrupt) or the work throws, after the work has ended
void attended(const std::function<void(const MustStop& must_stop)>& work, const std::function<void()>& told = {});

} // namespace graze::python
