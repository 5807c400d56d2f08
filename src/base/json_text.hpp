#pragma once

#include <string>
#include <string_view>

namespace graze {

/// Returns the text as a JSON string, with quotes and escapes.
std::string json_text(std::string_view text);

} // namespace graze
