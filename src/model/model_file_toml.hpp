#pragma once

#include "model/model_places.hpp"

// The parser is compiled in rather than linked, for its limits to be ours.
#undef TOML_SHARED_LIB
#undef TOML_HEADER_ONLY
#define TOML_HEADER_ONLY 1
#define TOML_MAX_NESTED_VALUES 64
#include <toml++/toml.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A value of a table, with its key.
struct TomlEntry {
    std::string name;
    std::string path; ///< as "modes.flight"
    Place place;      ///< of the key
    const toml::node* node = nullptr;
};

/// Parses TOML text. @param remedy where it is shown how such a file is written
/// @throws InputError with the place, also for nesting that would exhaust the stack
toml::table parse_toml(std::string_view text, const std::string& file,
                       const char* remedy = "docs/model-format.md shows how a model is written");

/// Reads typed values from nodes of a file; every mistake is an InputError with the place of the node.
class TomlReader {
public:
    explicit TomlReader(std::string file) : file_(std::move(file)) {}

    Place place(const toml::node& node) const { return place(node.source()); }
    /// In the order of the file. @param allowed when given, the only keys that may occur
    std::vector<TomlEntry> entries(const toml::table& table, const std::string& path) const;
    std::vector<TomlEntry> entries(const toml::table& table, const std::string& path,
                                   std::initializer_list<std::string_view> allowed) const;

    /// @param path of the table that it is in @throws InputError for a key that may not occur there
    void require_known(const TomlEntry& entry, const std::string& path,
                       std::initializer_list<std::string_view> allowed) const;
    void require_one_of(const std::vector<std::string>& names, const TomlEntry& entry, const std::string& path) const;

    const toml::table& table(const TomlEntry& entry) const;
    /// Elements, with paths such as "modes.flight.watch.1".
    std::vector<TomlEntry> elements(const TomlEntry& entry) const;
    /// Text in which nothing acts on a terminal (printable.hpp).
    std::string string(const TomlEntry& entry) const;
    /// The same on one line: a title, unit or label.
    std::string line(const TomlEntry& entry) const;
    bool boolean(const TomlEntry& entry) const;
    /// @param expected as "a number or an expression"
    [[noreturn]] void fail_type(const TomlEntry& entry, const std::string& expected) const;

private:
    Place place(const toml::source_region& region) const;

    std::string file_;
};

} // namespace graze
