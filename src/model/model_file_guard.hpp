#pragma once

#include "model/model_places.hpp"

#include <string_view>

namespace graze {

/// Refuses texts that the TOML parser cannot take safely: keys of very many parts, which nest tables without limit
/// and exhaust the stack, and characters outside ASCII where it looks for white space, where its behaviour is
/// undefined. Only texts, names in quotes and comments may hold such characters.
/// @throws InputError
void guard_toml(std::string_view text, const SourceText& source);

} // namespace graze
