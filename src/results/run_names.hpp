#pragma once

#include "graze/base/input_error.hpp"

#include <string>
#include <vector>

namespace graze {

/// Checks that a result file can store a run of this name.
/// @param branch whether it is a run of kind orbit or continue
/// @param others names of the other runs of the file
/// @throws InputError if it differs from another name only in case, which SQL ignores, or is the name of a view
void require_free_name(const std::string& name, bool branch, const std::vector<std::string>& others,
                       const Place& place);

} // namespace graze
