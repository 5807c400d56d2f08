#pragma once

#include "graze/design/design_report.hpp"
#include "python/attended.hpp"
#include "python/binding.hpp"

#include <functional>
#include <mutex>
#include <string>

namespace graze::python {

/// What a computation does at present, told by the threads that compute to the one that has called from Python.
class WorkNote {
public:
    void note(const std::string& what) {
        const std::lock_guard lock(mutex_);
        what_ = what;
    }
    std::string text() const {
        const std::lock_guard lock(mutex_);
        return what_;
    }

private:
    mutable std::mutex mutex_;
    std::string what_;
};

/// Computes a design, or what belongs to one, by `attended`.
/// @param told called with what is done at present; None: nothing is told
inline void attend_design(int threads, const py::object& told,
                          const std::function<void(const DesignReportOptions&)>& work) {
    WorkNote note;
    attended(
        [&](const std::function<bool()>& must_stop) {
            DesignReportOptions options;
            options.jobs = threads;
            options.interrupted = must_stop;
            options.progress = [&](const std::string& what) { note.note(what); };
            work(options);
        },
        told.is_none() ? std::function<void()>() : [&] { told(note.text()); });
}

} // namespace graze::python
