#pragma once

#include <cstddef>
#include <string>

namespace graze {

/// Characters in a line if the width of the terminal is not known.
constexpr std::size_t common_line_width = 100;

/// Number of characters, not bytes, of a text in UTF-8.
std::size_t width_of(const std::string& text);

/// The words of a text in lines of at most `width` characters; a longer word has a line of its own.
/// @param indent blanks before all lines but the first, which is assumed to begin at that column
std::string wrapped(const std::string& text, std::size_t width = common_line_width, std::size_t indent = 0);

} // namespace graze
