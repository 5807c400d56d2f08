#pragma once

#include "graze/design/wish_list.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// Returns the dimensions of a result.
std::vector<double> values_of(const FoundDesign& found);

/// Searches for a device with a trip time, which is discontinuous (it jumps from cycle to cycle), so gradients do not
/// help. From anchors all over the ranges it finds the nearest devices that meet the other requirements, and computes
/// their trip times; then it bisects between the first device and the best of these.
class TimeSearch {
public:
    /// @param list requirements, of which the trip time is the last; the dimensions start at the first device
    TimeSearch(const WishList& list, const WishOptions& options);

    /// @param nearest the device nearest to the first that meets the other requirements
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
