#pragma once

#include "model/model_places.hpp"

// The parser is compiled in rather than linked, so that the limits defined here apply.
#undef TOML_SHARED_LIB
#undef TOML_HEADER_ONLY
#define TOML_HEADER_ONLY 1
#define TOML_MAX_NESTED_VALUES 64
#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A key of a table with its value.
struct TomlEntry {
    std::string name;
    std::string path; ///< as "modes.flight"
    Place place;      ///< of the key
    const toml::node* node = nullptr;
};

/// Parses TOML text. @param remedy tells where the format is documented
/// @throws InputError with the place, also for nesting that would exhaust the stack
toml::table parse_toml(std::string_view text, const std::string& file,
                       const char* remedy = "docs/model-format.md shows how a model is written");

/// Reads typed values from the nodes of a file; every mistake is an InputError with the place of the node.
class TomlReader {
public:
    explicit TomlReader(std::string file) : file_(std::move(file)) {}

    Place place(const toml::node& node) const { return place(node.source()); }
    /// Returns the entries in the order of the file. @param allowed if given, the only keys that may occur
    std::vector<TomlEntry> entries(const toml::table& table, const std::string& path) const;
    std::vector<TomlEntry> entries(const toml::table& table, const std::string& path,
                                   const std::vector<std::string>& allowed) const;

    /// @param path of the table with the entry. @throws InputError for a key that is not allowed
    void require_known(const TomlEntry& entry, const std::string& path, const std::vector<std::string>& allowed) const;

    const toml::table& table(const TomlEntry& entry) const;
    /// Returns the elements of a list, with paths such as "modes.flight.watch.1".
    std::vector<TomlEntry> elements(const TomlEntry& entry) const;
    /// Returns a text without active characters (printable.hpp).
    std::string string(const TomlEntry& entry) const;
    /// Returns one line: a title, unit or label.
    std::string line(const TomlEntry& entry) const;
    bool boolean(const TomlEntry& entry) const;
    /// @param expected as "a number or an expression"
    [[noreturn]] void fail_type(const TomlEntry& entry, const std::string& expected) const;

private:
    Place place(const toml::source_region& region) const;

    std::string file_;
};

} // namespace graze
