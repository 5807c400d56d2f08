#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Returns the candidate nearest to `name` in edit distance, or "" when none is near.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// Returns names for a message, separated by commas. Of more than `most` names it shows `most`, nearest to `wanted`
/// first, and the number of the others.
/// @param wanted the misspelt name; if empty, the first names are shown
std::string name_list(const std::vector<std::string>& names, std::string_view wanted = {}, std::size_t most = 12);

} // namespace graze
