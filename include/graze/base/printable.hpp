#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace graze {

/// Returns whether a UTF-8 text is free of active characters: control characters (except line feed, carriage return and
/// tab), invisible marks and marks that reverse the direction of writing, and bytes that are not UTF-8.
bool is_plain_text(std::string_view text);
/// The same for one line: line feeds, carriage returns and tabs are not allowed either.
bool is_plain_line(std::string_view text);

/// Returns the text with each active character replaced by its code, as in \u001b (valid in JSON too), or by U+FFFD.
/// Line feeds and tabs are kept.
std::string printable(std::string_view text);
/// The same for one line: line feeds and tabs are replaced by their codes too.
std::string printable_line(std::string_view text);

/// Returns the number of bytes of an incomplete UTF-8 character at the end of the text; 0 if there is none.
std::size_t unfinished_character(std::string_view text);

/// Returns the text, or its beginning and end if it is longer than `most`. @param most bytes, at least 100
std::string shortened(std::string_view text, std::size_t most);

} // namespace graze
