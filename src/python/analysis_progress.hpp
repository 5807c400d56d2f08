#pragma once

#include "graze/base/with_place.hpp"
#include "python/attended.hpp"
#include "python/noted.hpp"

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

namespace graze::python {

// Arguments of analyses, for messages.
inline const Place of_point{"point", 0, 0}, of_parameter{"parameter", 0, 0};

/// How far an analysis of a point is: noted by the threads that compute, told by the one that has called from Python.
class AnalysisProgress {
public:
    /// @param of what is analysed
    explicit AnalysisProgress(std::string of) : of_(std::move(of)) {}

    void begin(std::size_t wanted) { wanted_ = wanted; }
    void note(std::size_t done) { done_ = done; }

    /// For `attended`: calls a function of Python with a dictionary as runs do; empty for None. This object has to live
    /// as long.
    std::function<void()> telling(const py::object& told) const {
        return python::telling(told, [this] {
            py::dict object;
            object["run"] = of_;
            for (const char* name : {"done", "all_done"})
                object[name] = done_.load();
            for (const char* name : {"points", "all_points"})
                object[name] = wanted_.load();
            object["parameter"] = py::none();
            return object;
        });
    }

private:
    std::string of_;
    std::atomic<std::size_t> done_ = 0, wanted_ = 0;
};

} // namespace graze::python
