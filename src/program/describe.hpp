#pragma once

#include "graze/model/model.hpp"
#include "program/wrapped_text.hpp"

#include <string>

namespace graze {

/// A readable listing of all states, parameters, modes and other parts of a model.
/// @param width characters in a line of its text
std::string describe(const Model& model, std::size_t width = common_line_width);

} // namespace graze
