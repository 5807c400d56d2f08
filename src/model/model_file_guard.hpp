#pragma once

#include "model/model_places.hpp"

#include <string_view>

namespace graze {

/// Refuses texts that the TOML parser cannot take safely: keys of very many parts, which nest tables without limit
/// and exhaust the stack; and those on which its behaviour is undefined: characters outside ASCII where it looks for
/// white space (only texts, names in quotes and comments may hold them), headers of tables that do not begin with a
/// name, and closing brackets of the wrong kind.
/// @throws InputError
void guard_toml(std::string_view text, const SourceText& source);

} // namespace graze
