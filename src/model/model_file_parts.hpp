#pragma once

#include "graze/base/input_errors.hpp"
#include "graze/model/model.hpp"
#include "graze/symbolic/parser.hpp"
#include "model/model_file_toml.hpp"
#include "model/model_places.hpp"

#include <functional>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace graze {

/// A model that is being read, and how the parts are read of which its tables are made: expressions, conditions,
/// choices, names of other things. Each notes its place, for mistakes that show only when all has been read.
class ModelParts {
protected:
    ModelParts(std::string_view text, const std::string& file)
        : source_(text, file), reader_(file), places_(file, &source_) {}

    /// Lets expressions use the names of parameters, states and definitions.
    void make_scope();

    /// A number or the text of an expression. One that is wrong is noted, and a number stands for it.
    Expression expression(const TomlEntry& entry);
    /// A number, which must be finite.
    double number(const TomlEntry& entry);
    /// Those that are wrong are noted, and left out.
    std::vector<Condition> conditions(const TomlEntry& entry);
    /// The entries of a table, or the short form: a value alone, which stands for `{ key = value }`.
    std::vector<TomlEntry> short_form(const TomlEntry& entry, const char* key,
                                      std::initializer_list<std::string_view> allowed) const;
    /// A map of states; those that are not mentioned stay as they are.
    StateMap state_map(const std::vector<TomlEntry>& entries);
    /// The map in which all stay. Call when all states have their names.
    const StateMap& identity();

    /// Index of a string among the choices.
    std::size_t choice(const TomlEntry& entry, const std::vector<std::string>& choices) const;
    /// Index of the item that a string names.
    template <typename Item>
    std::size_t index(const TomlEntry& entry, const std::vector<Item>& items, const char* kind) {
        places_.set(entry.path, reader_.place(*entry.node));
        return find(reader_.string(entry), reader_.place(*entry.node), items, kind);
    }
    /// Index of the item that a key names.
    template <typename Item>
    std::size_t key_index(const TomlEntry& entry, const std::vector<Item>& items, const char* kind) {
        return find(entry.name, entry.place, items, kind);
    }

    [[noreturn]] void fail_missing(const TomlEntry& entry, const char* what, const char* key) const;

    SourceText source_;
    TomlReader reader_;
    Places places_;
    Model model_;
    Mistakes mistakes_; ///< found so far

private:
    /// Places of the names of some items, which may get more of them but keep those that they have.
    struct NamePlaces {
        std::size_t known = 0;
        std::unordered_map<std::string, std::size_t> places;
    };
    template <typename Item>
    std::size_t find(const std::string& name, const Place& place, const std::vector<Item>& items, const char* kind) {
        NamePlaces& names = name_places_[kind];
        for (; names.known < items.size(); ++names.known)
            names.places.emplace(items[names.known].name, names.known);
        if (const auto found = names.places.find(name); found != names.places.end())
            return found->second;
        std::vector<std::string> all;
        for (const Item& item : items)
            all.push_back(item.name);
        fail_name(name, place, all, kind);
    }
    [[noreturn]] static void fail_name(const std::string& name, const Place& place,
                                       const std::vector<std::string>& names, const char* kind);
    Expression parsed_expression(const TomlEntry& entry);
    InputError inside(const TomlEntry& entry, const std::string& text, const InputError& error) const;
    template <typename Parse>
    auto parse_string(const TomlEntry& entry, Parse parse);

    Scope scope_;
    StateMap identity_;
    std::map<std::string, NamePlaces, std::less<>> name_places_; ///< of each kind of items
};

} // namespace graze
