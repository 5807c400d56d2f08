#pragma once

#include <string_view>

namespace graze {

/// A part of the text, which lives no longer than it: without the blanks at both ends.
std::string_view trimmed(std::string_view text, std::string_view blanks = " \t");

} // namespace graze
