#include "design/design_keys.hpp"

#include "graze/study/stored_study.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace graze {

void require_design_key(const TomlReader& reader, const TomlEntry& entry) {
    reader.require_known(entry, "",
                         {"name", "text", "source", "model", "control", "set", "approach", "trip", "points", "planes",
                          "dimensions", "yield", "adjustable", "wanted", "device", "process", "wafer", "rules",
                          "spread"});
}

namespace {

/// Serialises a node in a canonical form: sorted keys, numbers with all digits.
std::string text_of_node(const toml::node& node) {
    std::string text;
    if (const auto* table = node.as_table()) {
        for (const auto& [key, value] : *table)
            text += fmt::format("{}={};", key.str(), text_of_node(value));
        return '{' + text + '}';
    }
    if (const auto* array = node.as_array()) {
        for (const toml::node& item : *array)
            text += text_of_node(item) + ',';
        return '[' + text + ']';
    }
    if (const auto* one = node.as_string())
        return fmt::format("{}:{}", one->get().size(), one->get());
    if (const auto* one = node.as_integer())
        return fmt::format("{}", one->get());
    if (const auto* one = node.as_floating_point())
        return fmt::format("{}f", one->get());
    if (const auto* one = node.as_boolean())
        return one->get() ? "true" : "false";
    return "time"; // a date or time, which designs do not use
}

} // namespace

std::string design_fingerprint(const toml::table& root) {
    toml::table said = root;
    for (const char* other : {"text", "source", "points", "planes", "device", "process", "wafer", "rules", "spread"})
        said.erase(other);
    return fingerprint_of(text_of_node(said));
}

std::string beside(const std::string& file, const std::string& path) {
    return std::filesystem::path(path).is_relative() ? (std::filesystem::path(file).parent_path() / path).string()
                                                     : path;
}

} // namespace graze
