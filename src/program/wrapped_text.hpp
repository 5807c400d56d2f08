#pragma once

#include <cstddef>
#include <string>

namespace graze {

/// Letters in a line where nobody knows better: of windows on a screen and in print.
constexpr std::size_t common_line_width = 100;

/// Characters, not bytes, of UTF-8.
std::size_t width_of(const std::string& text);

/// Words in lines of at most a width, without blanks at their ends; a word that is longer has a line of its own.
/// @param indent blanks that all lines but the first begin with, and the first is thought to
std::string wrapped(const std::string& text, std::size_t width = common_line_width, std::size_t indent = 0);

} // namespace graze
