#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Reads the body of a request.
/// @throws InputError for what is no JSON in UTF-8, no object, nested more than 32 deep, or has a member twice
nlohmann::json request_json(std::string_view body);

/// Refuses a name that is not known, so that nobody takes for granted what is not looked at. @param what "member"
void require_known(const std::string& name, const std::vector<std::string>& known, const char* what);
/// The same for all members of an object.
void require_known_members(const nlohmann::json& object, const std::vector<std::string>& known);

/// Members of a request. Each function throws an InputError that names the member if it has another type or, unless
/// there is a default, is missing; null counts as missing.
std::string text_member(const nlohmann::json& request, const char* name);
std::string text_member(const nlohmann::json& request, const char* name, const std::string& otherwise);
bool flag_member(const nlohmann::json& request, const char* name, bool otherwise);
double number_member(const nlohmann::json& request, const char* name);
std::size_t count_member(const nlohmann::json& request, const char* name);
std::vector<std::string> texts_member(const nlohmann::json& request, const char* name);
/// An object; empty if it is missing.
nlohmann::json object_member(const nlohmann::json& request, const char* name);

/// A number of a point that stands in an address. @throws InputError that names it otherwise
std::size_t count_of(const std::string& text, const char* name);

} // namespace graze
