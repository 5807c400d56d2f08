#pragma once

#include "graze/design/wish_list.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// The dimensions of a design that was found.
std::vector<double> values_of(const FoundDesign& found);

/// Looks for a device with a trip time, which jumps from cycle to cycle: no gradient leads there. All over the ranges
/// the nearest devices that have the other wishes are found and timed; then the way from the first device to the best
/// of those is halved.
class TimeSearch {
public:
    /// @param list the wishes with the time, which is the last; their dimensions start at the first device
    TimeSearch(const WishList& list, const WishOptions& options);

    /// @param nearest the device nearest to the first that has the other wishes
    FoundDesign run(const FoundDesign& nearest);

private:
    bool is_met(const FoundDesign& one) const;
    std::vector<double> scattered(std::size_t number) const;
    FoundDesign anchored(const std::vector<double>& anchor);
    FoundDesign timed(FoundDesign found);
    void consider(FoundDesign& best, const FoundDesign& one) const;
    FoundDesign finished(FoundDesign best, bool met) const;

    Want time_;
    WishList others_;
    WishOptions options_;
    std::vector<double> first_;
    std::size_t left_ = 0, spent_ = 0;
};

} // namespace graze
