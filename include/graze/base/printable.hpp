#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace graze {

/// Whether a text, in UTF-8, has nothing in it that acts rather than is read: control characters besides line feed,
/// carriage return and tab, marks that reverse the direction of writing or cannot be seen, bytes that are no UTF-8.
bool is_plain_text(std::string_view text);
/// The same on one line: no line feeds, carriage returns and tabs either.
bool is_plain_line(std::string_view text);

/// What acts is shown by its code, as in \u001b (which JSON reads too), or as the sign for what cannot be shown.
/// Line feeds and tabs stay.
std::string printable(std::string_view text);
/// The same on one line: line feeds and tabs are shown by their codes too.
std::string printable_line(std::string_view text);

/// The bytes of an incomplete character at the end of a text, whose rest is still to come; 0 if there is none.
std::size_t unfinished_character(std::string_view text);

/// A text that is too long to be read is shown by its beginning and its end. @param most of its bytes, at least 100
std::string shortened(std::string_view text, std::size_t most);

} // namespace graze
