#pragma once

#include "graze/orbit/orbit.hpp"

#include <string>
#include <string_view>

namespace graze {

/// A candidate for an orbit from a table of its motion, as CSV: a line of names, then rows in the order of time.
/// Columns `segment` (1, 2, ...), `t`, and one for each state; of each segment its first row is the start, and the time
/// from its first to its last row the duration. The signature is what `signature` says or, if that is empty, what the
/// columns `end` (names as in signatures) and, where needed, `mode` say. Other columns do not matter.
/// Parameters are those of the model.
/// @param file the name to use in messages
/// @throws InputError with the place of the first thing wrong
Orbit parse_orbit_table(const Model& model, std::string_view text, std::string_view signature, const std::string& file);

/// The same from a file. @throws InputError also when it cannot be read
Orbit read_orbit_table(const Model& model, const std::string& path, std::string_view signature);

} // namespace graze
