#include "model/model_file_toml.hpp"

#include "graze/base/file_name.hpp"
#include "graze/base/input_errors.hpp"
#include "graze/base/printable.hpp"
#include "model/model_file_guard.hpp"
#include "model/model_validate.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

toml::table parse_toml(std::string_view text, const std::string& file, const char* remedy) {
    const SourceText source(text, file);
    if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos)
        throw InputError(source.place(zero), "the text has a zero byte", "remove it");
    guard_toml(text, source);
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        const toml::source_position at = error.source().begin;
        throw InputError({file, static_cast<int>(at.line), static_cast<int>(at.column)},
                         fmt::format("this is not TOML: {}", error.description()), remedy);
    }
}

Place TomlReader::place(const toml::source_region& region) const {
    return {file_, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

std::vector<TomlEntry> TomlReader::entries(const toml::table& table, const std::string& path) const {
    std::vector<TomlEntry> result;
    for (const auto& [key, node] : table) {
        const std::string name(key.str());
        result.push_back({name, path.empty() ? name : path + "." + name, place(key.source()), &node});
    }
    // The parser sorts tables by key, but the order in a model file is significant.
    std::sort(result.begin(), result.end(), [](const TomlEntry& one, const TomlEntry& other) {
        return std::pair(one.place.line, one.place.column) < std::pair(other.place.line, other.place.column);
    });
    return result;
}

std::vector<TomlEntry> TomlReader::entries(const toml::table& table, const std::string& path,
                                           const std::vector<std::string>& allowed) const {
    std::vector<TomlEntry> result = entries(table, path);
    Mistakes mistakes;
    for (const TomlEntry& entry : result)
        mistakes.attempt([&] { require_known(entry, path, allowed); });
    mistakes.throw_noted();
    return result;
}

void TomlReader::require_known(const TomlEntry& entry, const std::string& path,
                               const std::vector<std::string>& allowed) const {
    if (std::find(allowed.begin(), allowed.end(), entry.name) == allowed.end())
        throw InputError(entry.place, fmt::format("unknown key '{}'{}", entry.name, path.empty() ? "" : " in " + path),
                         name_remedy(entry.name, allowed));
}

const toml::table& TomlReader::table(const TomlEntry& entry) const {
    if (const toml::table* table = entry.node->as_table())
        return *table;
    fail_type(entry, "a table");
}

std::vector<TomlEntry> TomlReader::elements(const TomlEntry& entry) const {
    const toml::array* array = entry.node->as_array();
    if (array == nullptr)
        fail_type(entry, "a list");
    std::vector<TomlEntry> result;
    for (const toml::node& node : *array) {
        const std::string name = fmt::format("{}", result.size() + 1);
        result.push_back({name, entry.path + "." + name, place(node), &node});
    }
    return result;
}

std::string TomlReader::string(const TomlEntry& entry) const {
    const auto* value = entry.node->as_string();
    if (!value)
        fail_type(entry, "a string");
    if (!is_plain_text(value->get()))
        throw InputError(place(*entry.node),
                         fmt::format("{} has characters in it that control a terminal or cannot be seen", entry.path),
                         "leave them out");
    return value->get();
}

std::string TomlReader::line(const TomlEntry& entry) const {
    std::string text = string(entry);
    require_plain_line(text, entry.name, place(*entry.node));
    return text;
}

bool TomlReader::boolean(const TomlEntry& entry) const {
    if (const auto* value = entry.node->as_boolean())
        return value->get();
    fail_type(entry, "true or false");
}

void TomlReader::fail_type(const TomlEntry& entry, const std::string& expected) const {
    const auto found = [&]() -> std::string {
        switch (entry.node->type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "a list";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "true or false";
        default:
            return "a date or time";
        }
    }();
    throw InputError(place(*entry.node), fmt::format("{} must be {}, not {}", entry.path, expected, found),
                     fmt::format("give {}", expected));
}

} // namespace graze
