#pragma once

#include "graze/base/item_range.hpp"

#include <cstddef>
#include <map>
#include <vector>

namespace graze {

/// The state of one chain after an earlier, interrupted execution.
struct ChainProgress {
    std::size_t done = 0;      ///< number of completed points
    bool regular = false;      ///< whether the last point can be carried on from
    std::vector<double> state; ///< final state of the last point
    std::size_t mode = 0;
};

/// What is there of the chains of a plan after an earlier, interrupted execution. A plan may have millions of chains:
/// those that have not begun take no memory here, and neighbours that have ended take that of one.
class KnownChains {
public:
    /// All points of these chains are there.
    void end(ItemRange chains);
    /// Some points of a chain that has not ended are there.
    void begin(std::size_t chain, ChainProgress progress);

    bool has_ended(std::size_t chain) const;
    /// Null: nothing of the chain is there, or all.
    const ChainProgress* begun(std::size_t chain) const;
    /// How many of its points are there. @param length of each chain
    std::size_t done(std::size_t chain, std::size_t length) const;

    /// The chains that have ended: the first one of neighbours, and the one after their last.
    const std::map<std::size_t, std::size_t>& ended() const { return ended_; }
    /// The chains that have begun, by their numbers.
    const std::map<std::size_t, ChainProgress>& begun() const { return begun_; }
    /// Of the first `chains` chains those that have not ended, in rising order.
    std::vector<ItemRange> missing(std::size_t chains) const;
    /// What is known of some of the chains, which are numbered from 0 on there.
    KnownChains of(ItemRange chains) const;
    /// All chains of which something is known are before this one.
    std::size_t bound() const;

private:
    /// The first range that ends at a chain or after it.
    std::map<std::size_t, std::size_t>::const_iterator range_at(std::size_t chain) const;

    std::map<std::size_t, std::size_t> ended_; ///< no range touches another
    std::map<std::size_t, ChainProgress> begun_;
};

} // namespace graze
