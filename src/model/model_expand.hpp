#pragma once

#include "graze/model/model.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

/// Names of definitions or dependent parameters that refer to one another in a circle, the first repeated at the
/// end; empty when there is no circle.
std::vector<std::string> find_circle(const Model& model);

/// "a -> b -> a"
std::string circle_text(const std::vector<std::string>& names);

} // namespace graze
