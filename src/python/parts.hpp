#pragma once

#include "graze/study/run_part.hpp"
#include "graze/study/yield_part.hpp"
#include "python/binding.hpp"

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze::python {

/// Work that Python has an executor compute in parts, each of some items: chains of a run, or devices of a yield.
struct PartedWork {
    std::string text;                           ///< all that a worker needs besides the part, for PartWorker
    std::vector<ItemRange> missing;             ///< items that are to be computed, in rising order
    std::function<std::string(ItemRange)> part; ///< what a worker is given; called by another thread
    std::function<void(ItemRange, const std::string& result)> take; ///< what it has returned
};

/// Stands between the threads that carry out work, which wait for its items, and Python, which has an executor compute
/// them. Work that waits is "open", and has a number.
class PartExchange {
public:
    /// Waits until Python has given all items. Without the interpreter's lock, in any thread.
    /// @return false when it was interrupted
    bool await(const PartedWork& work, const std::function<bool()>& interrupted);

    /// The work that has opened since the last call: number, text, and ranges of items that are missing.
    py::list opened();
    /// Some items of open work, for an executor; empty when the work is not open any more.
    py::bytes part(std::size_t number, std::size_t first, std::size_t last) const;
    /// What has been computed for these items.
    void give(std::size_t number, std::size_t first, std::size_t last, std::string result);
    /// Lets open work fail.
    void fail(std::size_t number, const InputError& error);

private:
    struct Open {
        const PartedWork* work = nullptr;
        std::size_t missing = 0; ///< items that have not been given
        std::deque<std::pair<ItemRange, std::string>> given;
        std::optional<InputError> failure;
        bool is_told = false; ///< Python knows of it
    };

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::size_t, Open> open_;
    std::size_t next_ = 0;
};

/// For run_study and for yields: has points and devices computed by an executor; none without an exchange, for threads
/// of this process to compute them.
PointsElsewhere points_by(const std::shared_ptr<PartExchange>& parts);
DevicesElsewhere devices_by(const std::shared_ptr<PartExchange>& parts);

} // namespace graze::python
