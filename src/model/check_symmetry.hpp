#pragma once

#include "graze/model/model.hpp"

#include <string>
#include <vector>

namespace graze {

/// Says which rates a declared symmetry does not take to one another, judged at a few states around the initial one.
std::vector<std::string> symmetry_warnings(const Model& model);

} // namespace graze
