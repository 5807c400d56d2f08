#include "graze/sweep/known_chains.hpp"

#include "graze/base/require.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace graze {

void KnownChains::end(ItemRange chains) {
    require_room(chains.last, chains.first, "chains before those that have ended");
    if (chains.size() == 0)
        return;
    begun_.erase(begun_.lower_bound(chains.first), begun_.lower_bound(chains.last));
    // They join those that they touch.
    auto next = range_at(chains.first);
    while (next != ended_.end() && next->first <= chains.last) {
        chains = {std::min(chains.first, next->first), std::max(chains.last, next->second)};
        next = ended_.erase(next);
    }
    ended_.emplace_hint(next, chains.first, chains.last);
}

void KnownChains::begin(std::size_t chain, ChainProgress progress) {
    if (!has_ended(chain))
        begun_.insert_or_assign(chain, std::move(progress));
}

bool KnownChains::has_ended(std::size_t chain) const {
    const auto range = range_at(chain);
    return range != ended_.end() && range->first <= chain && chain < range->second;
}

const ChainProgress* KnownChains::begun(std::size_t chain) const {
    const auto found = begun_.find(chain);
    return found == begun_.end() ? nullptr : &found->second;
}

std::size_t KnownChains::done(std::size_t chain, std::size_t length) const {
    if (has_ended(chain))
        return length;
    const ChainProgress* some = begun(chain);
    return some ? std::min(some->done, length) : 0;
}

std::vector<ItemRange> KnownChains::missing(std::size_t chains) const {
    std::vector<ItemRange> ranges;
    std::size_t first = 0;
    const auto add = [&](std::size_t last) {
        if (first < std::min(last, chains))
            ranges.push_back({first, std::min(last, chains)});
    };
    for (const auto& [from, to] : ended_) {
        add(from);
        first = to;
    }
    add(chains);
    return ranges;
}

KnownChains KnownChains::of(ItemRange chains) const {
    KnownChains part;
    for (auto range = range_at(chains.first); range != ended_.end() && range->first < chains.last; ++range)
        part.end({std::max(range->first, chains.first) - chains.first,
                  std::min(std::max(range->second, chains.first), chains.last) - chains.first});
    for (auto one = begun_.lower_bound(chains.first); one != begun_.end() && one->first < chains.last; ++one)
        part.begun_.emplace_hint(part.begun_.end(), one->first - chains.first, one->second);
    return part;
}

std::map<std::size_t, std::size_t>::const_iterator KnownChains::range_at(std::size_t chain) const {
    const auto after = ended_.upper_bound(chain);
    return after != ended_.begin() && std::prev(after)->second >= chain ? std::prev(after) : after;
}

std::size_t KnownChains::bound() const {
    return std::max(ended_.empty() ? 0 : ended_.rbegin()->second, begun_.empty() ? 0 : begun_.rbegin()->first + 1);
}

} // namespace graze
