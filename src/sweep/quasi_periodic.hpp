#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// States at successive returns; only states that take part.
struct VisitedStates {
    std::vector<double> values;  ///< [return * periods.size() + state]
    std::vector<double> periods; ///< of each state; 0 if it is not cyclic

    std::size_t returns() const { return periods.empty() ? 0 : values.size() / periods.size(); }
};

/// Returns the largest difference of the averages over both halves of the returns, relative to the distance between
/// returns: tiny along a motion that fills a torus, of the order of the inverse square root of the number of returns
/// along a chaotic one (Das, Sander, Saiki and Yorke 2016). Infinite if the motion does not move, returns to an earlier
/// state, or has been observed for too short a time.
/// @param extents of the states
double unevenness(const VisitedStates& visited, std::span<const double> extents);

} // namespace graze
