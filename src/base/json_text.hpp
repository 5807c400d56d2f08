#pragma once

#include <string>
#include <string_view>

namespace graze {

/// A text between JSON's quotes.
std::string json_text(std::string_view text);

} // namespace graze
