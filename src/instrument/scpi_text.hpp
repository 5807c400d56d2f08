#pragma once

#include <string_view>
#include <vector>

namespace graze {

/// Splits a text at separators, and trims the parts.
std::vector<std::string_view> parts(std::string_view text, char separator);
/// Whether a word is the long or the short form of a keyword such as "FREQuency", whose capitals are the short form.
bool is_form_of(std::string_view word, std::string_view pattern);
/// Whether a header such as FREQ:MODE matches a pattern such as "FREQuency:MODE".
bool matches(std::string_view header, std::string_view pattern);

} // namespace graze
