#pragma once

#include "graze/base/item_range.hpp"
#include "graze/study/elsewhere.hpp"

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Work that others compute in parts, each of some items: chains of a run, or devices of a yield.
struct PartedWork {
    std::string text;                           ///< all that a worker needs besides the part
    std::vector<ItemRange> missing;             ///< items that are to be computed, in rising order
    std::function<std::string(ItemRange)> part; ///< what a worker is given; called by another thread
    /// Takes a piece of the result of a part. The pieces of a part come in order; the last one completes it.
    std::function<void(ItemRange part, const std::string& piece, bool is_last)> take;
};

/// Stands between the threads that carry out work, which wait for its items, and the thread that has others compute
/// them. Work that waits is "open", and has a number.
class PartExchange {
public:
    /// Waits until all items have been given. In any thread.
    /// @return false when it was interrupted; what has been given until then is kept
    /// @throws what the work failed with, or `take` throws
    bool await(const PartedWork& work, const std::function<bool()>& interrupted);

    /// Work that has been opened.
    struct Opened {
        std::size_t number = 0;
        std::string text;
        std::vector<ItemRange> missing;
    };
    /// The work that has opened since the last call.
    std::vector<Opened> opened();
    bool is_open(std::size_t number) const;
    /// Some items of open work, for a worker; none when the work is not open any more.
    std::optional<std::string> part(std::size_t number, ItemRange items) const;
    /// What has been computed for these items, or the rest of it.
    void give(std::size_t number, ItemRange items, std::string result);
    /// What has been computed for these items so far, since the last piece.
    void give_piece(std::size_t number, ItemRange items, std::string piece);
    /// Lets open work fail.
    void fail(std::size_t number, std::exception_ptr error);
    /// How much has been given that nobody has taken yet.
    std::size_t waiting() const;

private:
    struct Given {
        ItemRange items;
        std::string piece;
        bool is_last = true;
    };
    struct Open {
        const PartedWork* work = nullptr;
        std::size_t missing = 0; ///< items that have not been given
        std::deque<Given> given;
        std::exception_ptr failure;
        bool is_told = false; ///< `opened` has told of it
    };
    void take_all(Open& open, const std::function<bool()>& interrupted, std::unique_lock<std::mutex>& lock);
    void give(std::size_t number, Given given);

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::size_t, Open> open_;
    std::size_t next_ = 0;
};

/// For run_study: has points computed by whoever empties the exchange; none without an exchange, for threads of this
/// process to compute them.
PointsElsewhere points_by(const std::shared_ptr<PartExchange>& parts);

} // namespace graze
