#pragma once

#include "model/model_file_toml.hpp"

#include <string>

namespace graze {

/// Keys of a design file, whoever reads them: the designer what says how the device trips, the layout what is drawn.
/// @throws InputError for any other
void require_design_key(const TomlReader& reader, const TomlEntry& entry);

/// A path relative to the folder of the file that names it.
std::string beside(const std::string& file, const std::string& path);

} // namespace graze
