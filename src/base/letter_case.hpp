#pragma once

#include <string>
#include <string_view>

namespace graze {

/// Return the text with its ASCII letters in lower or upper case; other characters are unchanged.
std::string in_small_letters(std::string_view text);
std::string in_capitals(std::string_view text);

} // namespace graze
