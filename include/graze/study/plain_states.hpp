#pragma once

#include "graze/model/model.hpp"

#include <string>
#include <vector>

namespace graze {

// What is drawn, and whose passages are counted, when the user names nothing.

/// Names of a displacement and its velocity: the first state, neither cyclic nor drifting, whose rate is another such
/// state; otherwise the first two. Empty where there are fewer than two.
std::vector<std::string> default_portrait(const Model& model);
/// Names of the first states that are neither cyclic nor drifting, as many as pictures show over time.
std::vector<std::string> plain_states(const Model& model);
/// Name of the section of a cyclic state, or else of the first section; empty where there is none.
std::string usual_section(const Model& model);

} // namespace graze
