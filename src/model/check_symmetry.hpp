#pragma once

#include "graze/model/model.hpp"

#include <string>
#include <vector>

namespace graze {

/// Returns warnings about rates that violate a declared symmetry, tested at a few states around the initial one.
std::vector<std::string> symmetry_warnings(const Model& model);

} // namespace graze
