#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// The candidate nearest to `name` in edit distance, or "" when none is near.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// Names for a message, separated by commas: all of a few; of more than `most` so many, the nearest to the one that was
/// wanted first, and how many there are besides.
/// @param wanted empty: the first ones are shown
std::string name_list(const std::vector<std::string>& names, std::string_view wanted = {}, std::size_t most = 12);

} // namespace graze
