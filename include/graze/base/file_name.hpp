#pragma once

#include "graze/base/input_error.hpp"

#include <cstddef>
#include <string_view>

namespace graze {

inline constexpr std::size_t longest_name = 100;

/// Whether a name that somebody else has chosen can be a file's, a table's and a title's: letters, digits, '.', '_' and
/// '-' of ASCII, not '.' or '-' at the start, and no more than `longest_name`. It then leads out of no folder, is no
/// option of a command, and needs no quotes anywhere.
bool is_file_name(std::string_view name);

/// @param what as in "name of a run"
/// @throws InputError unless it is one
void require_file_name(std::string_view name, std::string_view what, const Place& place);

/// Titles, units, labels and the like: one line of at most 10000 bytes in which nothing acts (printable.hpp).
/// @throws InputError unless it is one
void require_plain_line(std::string_view text, std::string_view what, const Place& place);

} // namespace graze
