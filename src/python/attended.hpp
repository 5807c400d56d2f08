#pragma once

#include <functional>

namespace graze::python {

/// Does work in a thread of its own, without the interpreter's lock, while the calling thread, which holds the lock,
/// looks for signals such as Ctrl-C some fifty times a second and calls `told`.
/// @param work is given a function that says whether it has to stop; it is called from any thread
/// @param told is called with the lock; may be empty. What it throws stops the work
/// @throws what `told`, a handler of signals (as KeyboardInterrupt) or the work throws, after the work has ended
void attended(const std::function<void(const std::function<bool()>& must_stop)>& work,
              const std::function<void()>& told = {});

} // namespace graze::python
