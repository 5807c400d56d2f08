#pragma once

#include "graze/model/model.hpp"

#include <string>
#include <vector>

namespace graze {

// What of a model's state is drawn when nothing is said.

/// A displacement and its velocity: the first plain state whose rate is another one, or else the first two. Empty where
/// there are fewer than two.
std::vector<std::string> default_portrait(const Model& model);
/// The first states that are neither cyclic nor drifting, as many as are shown over time.
std::vector<std::string> plain_states(const Model& model);

} // namespace graze
