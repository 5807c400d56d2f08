#pragma once

#include "graze/model/model.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A model that comes with graze.
struct CatalogueEntry {
    std::string name;
    std::string summary; ///< one line
    std::string text;    ///< the model file, whole
};

/// The shipped models, built into the library (the files of models/), in alphabetical order.
const std::vector<CatalogueEntry>& catalogue();
/// Their names.
std::vector<std::string> shipped_models();
std::optional<CatalogueEntry> find_in_catalogue(std::string_view name);

/// Whether this is the path of a model file: it contains a slash or ends in ".toml". Other names are in the catalogue.
bool is_model_path(std::string_view name_or_path);

/// The model of this name or in this file. "microbeam-9" is the member of the microbeam's family with nine modes.
/// @throws InputError when there is neither (with the nearest name)
Model load_model(const std::string& name_or_path);

} // namespace graze
