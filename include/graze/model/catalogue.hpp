#pragma once

#include "graze/model/model.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A model that is shipped with graze.
struct CatalogueEntry {
    std::string name;
    std::string summary; ///< one line
    std::string text;    ///< contents of the model file
};

/// The shipped models, built into the library (the files of models/), in alphabetical order.
const std::vector<CatalogueEntry>& catalogue();
/// Returns the names of the shipped models.
std::vector<std::string> shipped_models();
std::optional<CatalogueEntry> find_in_catalogue(std::string_view name);

/// Returns whether the text is a path of a model file: it contains a slash or ends in ".toml". Other texts are names in
/// the catalogue.
bool is_model_path(std::string_view name_or_path);

/// Returns the shipped model of this name, or the model in this file. "microbeam-9" is the microbeam with nine modes.
/// @throws InputError when there is no such model (with the nearest name) or the file has a mistake
Model load_model(const std::string& name_or_path);

} // namespace graze
