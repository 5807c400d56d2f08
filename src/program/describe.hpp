#pragma once

#include "graze/model/model.hpp"
#include "program/wrapped_text.hpp"

#include <string>

namespace graze {

/// Everything in a model that has a name, for people. @param width letters in a line of its text
std::string describe(const Model& model, std::size_t width = common_line_width);

} // namespace graze
