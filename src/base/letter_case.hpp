#pragma once

#include <string>
#include <string_view>

namespace graze {

/// A text with the letters of ASCII made small, or capital; all else stays.
std::string in_small_letters(std::string_view text);
std::string in_capitals(std::string_view text);

} // namespace graze
