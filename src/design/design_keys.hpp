#pragma once

#include "model/model_file_toml.hpp"

namespace graze {

/// Keys of a design file, whoever reads them: the designer what says how the device trips, the layout what is drawn.
/// @throws InputError for any other
void require_design_key(const TomlReader& reader, const TomlEntry& entry);

} // namespace graze
