#pragma once

#include "model/model_file_toml.hpp"

#include <string>

namespace graze {

/// Checks that a key is one of a design file (of the design or of its layout).
/// @throws InputError for any other key
void require_design_key(const TomlReader& reader, const TomlEntry& entry);

/// Returns a hash that is equal for design files that lead to the same device, and differs for others: texts, layout
/// and resolution of curves do not enter.
std::string design_fingerprint(const toml::table& root);

/// Resolves a path relative to the folder of the file that names it.
std::string beside(const std::string& file, const std::string& path);

} // namespace graze
