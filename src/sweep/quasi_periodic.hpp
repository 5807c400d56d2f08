#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// States at successive returns, those that take part only.
struct VisitedStates {
    std::vector<double> values;  ///< [return * periods.size() + state]
    std::vector<double> periods; ///< of each state; 0 if it is not cyclic

    std::size_t returns() const { return periods.empty() ? 0 : values.size() / periods.size(); }
};

/// Largest difference of the averages over both halves of the returns, relative to how far returns are apart: tiny
/// along a motion that fills a torus, the inverse root of the returns along a chaotic one (Das, Sander, Saiki and Yorke
/// 2016). Infinite where the motion does not move, comes back to where it was, or has been seen for too short a time.
/// @param extents of the states
double unevenness(const VisitedStates& visited, std::span<const double> extents);

} // namespace graze
