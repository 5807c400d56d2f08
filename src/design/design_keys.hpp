#pragma once

#include "model/model_file_toml.hpp"

#include <string>

namespace graze {

/// Keys of a design file, whoever reads them: the designer what says how the device trips, the layout what is drawn.
/// @throws InputError for any other
void require_design_key(const TomlReader& reader, const TomlEntry& entry);

/// The same for design files that lead to the same device, and different for others: of all but words, what is drawn of
/// the device, and how closely curves are.
std::string design_fingerprint(const toml::table& root);

/// A path relative to the folder of the file that names it.
std::string beside(const std::string& file, const std::string& path);

} // namespace graze
