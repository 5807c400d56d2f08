#pragma once

#include "graze/base/item_range.hpp"

#include <cstddef>
#include <deque>
#include <vector>

namespace graze {

/// Cuts work into parts as workers become free: the first ones are small, later ones take about half a second, and the
/// last ones less, so that all workers end together.
class PartSizes {
public:
    /// @param missing items that are to be computed, in rising order @throws InputError for a range that ends before it
    /// begins
    explicit PartSizes(const std::vector<ItemRange>& missing);

    bool has_more() const { return !ranges_.empty(); }
    /// Items of the next part. @throws InputError when there are no more
    ItemRange cut(std::size_t workers);
    /// How long a part has taken.
    void note(std::size_t items, double seconds);
    /// Whether a part of this work is known to take no longer than about a second.
    bool is_brief() const;

private:
    std::size_t size(std::size_t workers) const;

    std::deque<ItemRange> ranges_;
    std::size_t left_ = 0;  ///< items that are in no part
    std::size_t timed_ = 0; ///< items that have taken `seconds_`
    double seconds_ = 0;
    std::size_t largest_ = 0; ///< items of a part whose duration is known
};

} // namespace graze
