#include "page/toml_value.hpp"

#include "graze/base/input_error.hpp"

namespace graze {

namespace {

/// Strings, numbers and truth values are written alike in both.
std::string as_in_json(const nlohmann::json& value) {
    return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace

std::string toml_value(const nlohmann::json& value) {
    if (value.is_null())
        throw InputError("a value is null", "leave it out");
    if (!value.is_structured())
        return as_in_json(value);
    const bool table = value.is_object();
    std::string text;
    for (const auto& [name, item] : value.items())
        text += (text.empty() ? "" : ", ") + (table ? as_in_json(name) + " = " : "") + toml_value(item);
    return table ? "{ " + text + " }" : "[" + text + "]";
}

std::string toml_lines(const nlohmann::json& object) {
    std::string text;
    for (const auto& [name, value] : object.items())
        if (!value.is_null())
            text += as_in_json(name) + " = " + toml_value(value) + "\n";
    return text;
}

} // namespace graze
