#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace graze {

/// A value as a TOML file has it. @throws InputError for null, which TOML does not know
std::string toml_value(const nlohmann::json& value);
/// The members of an object as the lines of a TOML table; those that are null are left out.
std::string toml_lines(const nlohmann::json& object);

} // namespace graze
