#include "graze/study/part_exchange.hpp"

#include "graze/base/require.hpp"

#include <chrono>
#include <utility>

namespace graze {

namespace {

constexpr std::chrono::milliseconds between_answers{20};

} // namespace

void PartExchange::take_all(Open& open, const std::function<bool()>& interrupted, std::unique_lock<std::mutex>& lock) {
    while (open.missing > 0 || !open.given.empty()) {
        if (!open.given.empty()) { // even if the work is interrupted
            const Given given = std::move(open.given.front());
            open.given.pop_front();
            lock.unlock();
            open.work->take(given.items, given.piece, given.is_last);
            lock.lock();
            continue;
        }
        if (open.failure)
            std::rethrow_exception(open.failure);
        if (interrupted && interrupted())
            return;
        changed_.wait_for(lock, between_answers);
    }
}

bool PartExchange::await(const PartedWork& work, const std::function<bool()>& interrupted) {
    std::size_t missing = 0;
    for (const ItemRange& range : work.missing)
        missing += range.size();
    if (missing == 0)
        return true;
    std::unique_lock lock(mutex_);
    const std::size_t number = next_++;
    Open& open = open_[number]; // stays where it is while others come and go
    open.work = &work;
    open.missing = missing;
    const auto close = [&] {
        if (!lock.owns_lock())
            lock.lock();
        open_.erase(number);
    };
    try {
        take_all(open, interrupted, lock);
    } catch (...) {
        close();
        throw;
    }
    const bool complete = open.missing == 0;
    close();
    return complete;
}

std::vector<PartExchange::Opened> PartExchange::opened() {
    std::vector<Opened> all;
    const std::lock_guard lock(mutex_);
    for (auto& [number, open] : open_)
        if (!std::exchange(open.is_told, true))
            all.push_back({number, open.work->text, open.work->missing});
    return all;
}

bool PartExchange::is_open(std::size_t number) const {
    const std::lock_guard lock(mutex_);
    return open_.contains(number);
}

std::optional<std::string> PartExchange::part(std::size_t number, ItemRange items) const {
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(number);
    if (found == open_.end())
        return std::nullopt;
    require_room(items.last, items.first, "items before a part");
    require_room(found->second.work->missing.back().last, items.last, "items of a part");
    return found->second.work->part(items);
}

void PartExchange::give(std::size_t number, Given given) {
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(number);
    if (found == open_.end())
        return;
    require_room(given.items.last, given.items.first, "items before a part");
    require_room(found->second.missing, given.items.size(), "missing items");
    if (given.is_last)
        found->second.missing -= given.items.size();
    found->second.given.push_back(std::move(given));
    changed_.notify_all();
}

void PartExchange::give(std::size_t number, ItemRange items, std::string result) {
    give(number, Given{items, std::move(result), true});
}

void PartExchange::give_piece(std::size_t number, ItemRange items, std::string piece) {
    give(number, Given{items, std::move(piece), false});
}

void PartExchange::fail(std::size_t number, std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    const auto found = open_.find(number);
    if (found == open_.end())
        return;
    found->second.failure = std::move(error);
    changed_.notify_all();
}

std::size_t PartExchange::waiting() const {
    const std::lock_guard lock(mutex_);
    std::size_t count = 0;
    for (const auto& [number, open] : open_)
        count += open.given.size();
    return count;
}

PointsElsewhere points_by(const std::shared_ptr<PartExchange>& parts) {
    if (!parts)
        return {};
    return [parts](const AskedPoints& asked, const PointSink& sink) {
        const PartedRun& run = asked.run;
        const KnownChains& known = asked.known;
        std::map<std::size_t, PointsReader> begun; // by the first chain of the part
        const auto take = [&](ItemRange chains, const std::string& piece, bool is_last) {
            const auto reader = begun.try_emplace(chains.first, run, RunPart{chains, known.of(chains)}).first;
            reader->second.read(piece, is_last, sink);
            if (is_last)
                begun.erase(reader);
        };
        return parts->await({run.text(), known.missing(run.chains()),
                             [&](ItemRange chains) {
                                 return bytes_of(RunPart{chains, known.of(chains)});
                             },
                             take},
                            asked.interrupted);
    };
}

} // namespace graze
