#pragma once

#include <cstddef>
#include <vector>

namespace graze {

/// Returns the sets of two or more states whose translation by one distance changes nothing to first order: null
/// vectors of all gradients with entries 0 and 1, of which some gradients do change with single states.
/// @param gradients rows of derivatives by all states, one after another; rows that are not finite do not count
std::vector<std::vector<std::size_t>> sets_moved_together(const std::vector<double>& gradients, std::size_t states);

} // namespace graze
