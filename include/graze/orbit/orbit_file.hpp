#pragma once

#include "graze/orbit/orbit.hpp"

#include <string>
#include <string_view>

namespace graze {

/// Reads a candidate for an orbit from a CSV table of its motion: a line of column names, then rows in the order of
/// time. Required columns are `segment` (1, 2, ...), `t` and one per state. The first row of a segment is its start;
/// the time between its first and last row is its duration. The signature is the argument `signature` or, if that is
/// empty, is read from the column `end` (names as in signatures) and, where modes are ambiguous, `mode`. Other columns
/// are ignored. The orbit gets the model's parameters.
/// @param file name of the table in messages
/// @throws InputError with the place of the first mistake
Orbit parse_orbit_table(const Model& model, std::string_view text, std::string_view signature, const std::string& file);

/// The same for a file. @throws InputError also when the file cannot be read
Orbit read_orbit_table(const Model& model, const std::string& path, std::string_view signature);

} // namespace graze
