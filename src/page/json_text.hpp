#pragma once

#include <nlohmann/json.hpp>

#include <span>
#include <string>

namespace graze {

/// Returns the text of a JSON value. Every text that the page gets is made here, because names and texts of files may
/// have any bytes: those that are not UTF-8 become replacement characters. The character '<' is written as its code, so
/// that the text can stand within a script of a page, which nothing in it can end.
std::string json_text(const nlohmann::json& value);

/// A number; null if it is not finite.
nlohmann::json number_json(double value);
/// A list of numbers.
nlohmann::json numbers_json(std::span<const double> values);

} // namespace graze
