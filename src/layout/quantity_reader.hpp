#pragma once

#include "study/study_reader.hpp"

#include <string>

namespace graze {

/// Parses a number or an expression, optionally followed by a unit of the same dimension, and returns the value in
/// `unit`.
/// @param name for messages @param units description of the units for the remedy
/// @param inside place at which the text itself begins @throws InputError with the place
double quantity_of_text(const std::string& text, const std::string& name, const char* unit, const Place& place,
                        const Place& inside, const char* units = nullptr);
/// Reads such a value from an entry, which may be a number. @throws InputError with the place
double read_quantity(const StudyReader& reader, const TomlEntry& entry, const char* unit, const char* units = nullptr);

} // namespace graze
