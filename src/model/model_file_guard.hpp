#pragma once

#include "model/model_places.hpp"

#include <string_view>

namespace graze {

/// Refuses texts that the TOML parser cannot process safely: keys of very many parts, which nest tables without limit
/// and exhaust the stack; and texts for which the parser's behaviour is undefined: characters outside ASCII where it
/// expects white space (only strings, quoted names and comments may contain them), table headers that do not begin with
/// a name, and closing brackets of the wrong kind.
/// @throws InputError for such a text
void guard_toml(std::string_view text, const SourceText& source);

} // namespace graze
