#pragma once

#include <string_view>

namespace graze {

/// Returns the text without the blanks at both ends, as a view of the same characters.
std::string_view trimmed(std::string_view text, std::string_view blanks = " \t");

} // namespace graze
