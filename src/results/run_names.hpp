#pragma once

#include "graze/base/input_error.hpp"

#include <string>
#include <vector>

namespace graze {

/// @param branch whether it is a run of kind orbit or continue
/// @param others names of the other runs of its file
/// @throws InputError when a result file cannot keep a run of this name beside them: SQL does not tell upper and lower
///         case apart, and some names are those of views
void require_free_name(const std::string& name, bool branch, const std::vector<std::string>& others,
                       const Place& place);

} // namespace graze
