#pragma once

#include "graze/symbolic/expression.hpp"

#include <string>

namespace graze {

/// Returns a TOML string; a multi-line string when the text has several lines.
std::string toml_string(const std::string& text);
/// Returns a key of TOML, in quotes where it must be.
std::string toml_key(const std::string& name);
/// Returns a number that reads back to the same double.
std::string number_text(double value);
/// Returns the text of an expression that reads back to the same one, numbers included.
std::string written_text(const Expression& expression);
/// Returns the value of a key for such a text: a number as it is, anything else in quotes.
std::string value_of_written(const std::string& text);

} // namespace graze
