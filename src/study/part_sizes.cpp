#include "graze/study/part_sizes.hpp"

#include "graze/base/require.hpp"
#include "graze/tape/jet.hpp"

#include <algorithm>

namespace graze {

namespace {

constexpr double wanted_seconds = 0.5; ///< that a part is to take
constexpr double fewest = 5;           ///< near the end, parts are smaller by this factor at most
constexpr double growth = 8; ///< the next part is larger by this factor at most than those whose duration is known
constexpr double least_seconds = 1e-6;

/// How many motions one core computes at once at best.
std::size_t motions_together() {
    return 2 * static_cast<std::size_t>(lanes_of(LaneKind::ensemble, best_instruction_set()));
}

} // namespace

PartSizes::PartSizes(const std::vector<ItemRange>& missing) {
    for (const ItemRange& range : missing) {
        require_room(range.last, range.first, "items before missing ones");
        if (range.size() > 0)
            ranges_.push_back(range);
        left_ += range.size();
    }
}

std::size_t PartSizes::size(std::size_t workers) const {
    if (timed_ == 0)
        return 1; // an item may take minutes
    const double wanted = wanted_seconds * static_cast<double>(timed_) / std::max(least_seconds, seconds_);
    const double share = static_cast<double>(left_) / (2.0 * static_cast<double>(std::max<std::size_t>(workers, 1)));
    const double best = std::min({wanted, std::max(share, wanted / fewest), growth * static_cast<double>(largest_)});
    const std::size_t most = ranges_.front().size();
    if (best >= static_cast<double>(most))
        return most;
    const std::size_t size = static_cast<std::size_t>(std::max(best, 1.0)), together = motions_together();
    return size > together ? size - size % together : size;
}

ItemRange PartSizes::cut(std::size_t workers) {
    require_room(ranges_.size(), 1, "ranges of items");
    ItemRange& front = ranges_.front();
    const ItemRange part{front.first, front.first + size(workers)};
    front.first = part.last;
    if (front.size() == 0)
        ranges_.pop_front();
    left_ -= part.size();
    return part;
}

void PartSizes::note(std::size_t items, double seconds) {
    timed_ += items;
    seconds_ += seconds;
    largest_ = std::max(largest_, items);
}

bool PartSizes::is_brief() const {
    return timed_ > 0 && seconds_ < 2 * wanted_seconds * static_cast<double>(timed_);
}

} // namespace graze
