#pragma once

#include "graze/base/input_error.hpp"

#include <cstddef>
#include <string_view>

namespace graze {

inline constexpr std::size_t longest_name = 100;

/// Returns whether a name chosen by a user is safe as the name of a file, a table or a picture's title: at most
/// `longest_name` ASCII letters, digits, '.', '_' and '-', not starting with '.' or '-'. Such a name cannot lead out of
/// a folder, is never read as a command's option, and needs no quotes anywhere.
bool is_file_name(std::string_view name);

/// Checks that `is_file_name(name)`.
/// @param what names the thing in the message, as in "name of a run"
/// @throws InputError if the name is not safe
void require_file_name(std::string_view name, std::string_view what, const Place& place);

/// Checks a title, unit, label or the like: one line of at most 10000 bytes that passes `is_plain_line`.
/// @throws InputError if the text is longer or not plain
void require_plain_line(std::string_view text, std::string_view what, const Place& place);

} // namespace graze
