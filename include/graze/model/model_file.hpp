#pragma once

#include "graze/model/model.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Reads a model from TOML text; docs/model-format.md describes it.
/// @param file the name to use in messages
/// @throws InputError with the place for one mistake, InputErrors for several
Model parse_model(std::string_view text, const std::string& file);
/// The keys and tables that a model file may have at its top.
const std::vector<std::string>& model_keys();
/// Reads a model file. @throws InputError also when the file cannot be read
Model read_model(const std::string& path);
/// Returns the text of a model file that reads back to the same model.
/// @throws InputError when the model is not valid
std::string write_model(const Model& model);
/// Returns the same without the drawing: all that numbers depend on.
std::string write_equations(const Model& model);

} // namespace graze
