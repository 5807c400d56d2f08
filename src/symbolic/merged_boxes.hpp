#pragma once

#include "graze/symbolic/zero_search.hpp"

#include <span>
#include <vector>

namespace graze {

/// Replaces boxes that touch by the smallest box around them, until no two touch; sorted by their lower ends.
/// @param gaps for each unknown, up to which boxes count as touching
/// @param part of the larger one's extent up to which they do so too
std::vector<IntervalBox> merged_boxes(std::vector<IntervalBox> boxes, std::span<const double> gaps, double part);

} // namespace graze
