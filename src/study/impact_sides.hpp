#pragma once

#include "graze/record/impacts.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// All channels of a record just before an impact and just after it.
struct ImpactSides {
    std::size_t impact = 0; ///< index
    std::vector<double> before, after;
};

/// Continues each channel to the time of each impact, from either side by itself, so that corners and jumps stay where
/// they are: by the parabola that fits the five nearest rows of that side best (fewer where the next impact is nearer,
/// a straight line through two). Rows so near that they may be of the other side are left out. Where a side has no
/// rows, the other one's value is given.
/// @param record from its beginning
/// @param impacts as find_impacts gives them
/// @param transition rows on both sides that the impact itself disturbs
std::vector<ImpactSides> impact_sides(SampleSource& record, const std::vector<RecordedImpact>& impacts,
                                      std::size_t transition);

} // namespace graze
