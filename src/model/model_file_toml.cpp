#include "model/model_file_toml.hpp"

#include "graze/symbolic/input_error.hpp"
#include "model/model_validate.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

/// Dotted keys nest tables without any limit in the parser, which then recurses through them.
constexpr int most_parts_of_a_key = 16;

/// Skips the string that starts at `at`; returns the position after it.
std::size_t skip_string(std::string_view text, std::size_t at) {
    const char quote = text[at];
    const bool long_form = text.substr(at, 3) == std::string(3, quote);
    at += long_form ? 3 : 1;
    while (at < text.size()) {
        if (quote == '"' && text[at] == '\\') {
            at += 2;
        } else if (!long_form && (text[at] == quote || text[at] == '\n')) {
            return at + 1;
        } else if (long_form && text.substr(at, 3) == std::string(3, quote)) {
            at += 3;
            // Up to two more quotes belong to the value.
            for (int extra = 0; extra < 2 && at < text.size() && text[at] == quote; ++extra)
                ++at;
            return at;
        } else {
            ++at;
        }
    }
    return text.size();
}

bool is_key_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == ' ' || c == '\t';
}

/// Refuses keys of very many parts (a.b.c. ...), before the parser sees them.
void check_keys(std::string_view text, const std::string& file) {
    int parts = 1;
    int line = 1;
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        if (c == '"' || c == '\'') {
            const std::size_t end = std::min(skip_string(text, at), text.size());
            line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                                                text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
            at = end;
            continue;
        }
        if (c == '#') {
            at = std::min(text.find('\n', at), text.size());
            continue;
        }
        if (c == '.')
            ++parts;
        else if (!is_key_character(c))
            parts = 1;
        if (parts > most_parts_of_a_key)
            throw InputError({file, line, 0}, fmt::format("a key of more than {} parts", most_parts_of_a_key),
                             "no key of a model has more than three");
        line += c == '\n' ? 1 : 0;
        ++at;
    }
}

} // namespace

toml::table parse_toml(std::string_view text, const std::string& file) {
    check_keys(text, file);
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        const toml::source_position at = error.source().begin;
        throw InputError({file, static_cast<int>(at.line), static_cast<int>(at.column)},
                         fmt::format("this is not TOML: {}", error.description()),
                         "docs/model-format.md shows how a model is written");
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
    // The parser keeps tables sorted by key, but the order in a model means something.
    std::sort(result.begin(), result.end(), [](const TomlEntry& one, const TomlEntry& other) {
        return std::pair(one.place.line, one.place.column) < std::pair(other.place.line, other.place.column);
    });
    return result;
}

std::vector<TomlEntry> TomlReader::entries(const toml::table& table, const std::string& path,
                                           std::initializer_list<std::string_view> allowed) const {
    std::vector<TomlEntry> result = entries(table, path);
    for (const TomlEntry& entry : result)
        if (std::find(allowed.begin(), allowed.end(), entry.name) == allowed.end())
            throw InputError(entry.place,
                             fmt::format("unknown key '{}'{}", entry.name, path.empty() ? "" : " in " + path),
                             name_remedy(entry.name, {allowed.begin(), allowed.end()}));
    return result;
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
    if (const auto* value = entry.node->as_string())
        return value->get();
    fail_type(entry, "a string");
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
