#pragma once

#include "graze/study/run_part.hpp"
#include "python/binding.hpp"

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace graze::python {

/// Stands between the threads that carry out a study, which wait for points, and Python, which has an executor compute
/// them. A run that waits is "open", and has a number.
class PartExchange {
public:
    /// For run_study: waits until Python has given all points. Without the interpreter's lock, in any thread.
    bool await(const PartedRun& run, std::span<const ChainProgress> known, const std::function<bool()>& interrupted,
               const PointSink& sink);

    /// The runs that have opened since the last call: number, text, and ranges of chains that are not complete.
    py::list opened();
    /// Some chains of an open run, for an executor; empty when the run is not open any more.
    py::bytes part(std::size_t number, std::size_t first, std::size_t last) const;
    /// What has been computed for a part.
    void give(std::size_t number, const std::string& part, std::string points);
    /// Lets an open run fail.
    void fail(std::size_t number, const InputError& error);

private:
    struct Open {
        const PartedRun* run = nullptr;
        std::span<const ChainProgress> known;
        std::size_t missing = 0; ///< chains that are not complete and have not been given
        std::deque<std::pair<RunPart, std::string>> given;
        std::optional<InputError> failure;
        bool is_told = false; ///< Python knows of it
    };

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::size_t, Open> open_;
    std::size_t next_ = 0;
};

} // namespace graze::python
