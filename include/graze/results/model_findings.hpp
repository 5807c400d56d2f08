#pragma once

#include "graze/model/check.hpp"

#include <vector>

namespace graze {

/// All warnings of `graze check`: those of `located_warnings`, and what a short motion from the initial state and the
/// comparison of derivatives with differences find. It may take a second or two.
/// @throws InputError when the model is not valid
std::vector<ModelWarning> model_findings(const Model& model);

} // namespace graze
