#pragma once

#include "graze/model/model.hpp"

#include <string>

namespace graze {

/// Returns a symbol in the model's graph whose name the model does not use.
/// @param base the name, with underscores added where it is in use
Expression unused_symbol(Model& model, const std::string& base);

} // namespace graze
