#pragma once

#include "graze/base/input_errors.hpp"
#include "graze/model/model.hpp"
#include "graze/symbolic/parser.hpp"
#include "model/model_expressions.hpp"
#include "model/model_file_toml.hpp"
#include "model/model_places.hpp"

#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace graze {

/// A model that is being read, and readers of the parts of its tables: expressions, conditions, choices, names of other
/// items. Each records the place of what it reads, for mistakes that only show after the whole file has been read.
class ModelParts {
protected:
    ModelParts(std::string_view text, const std::string& file)
        : source_(text, file), reader_(file), places_(file, &source_) {}

    /// Makes the names of parameters, states and definitions known to expressions, also those of frictions and
    /// controls.
    void make_scope() {
        scope_ = scope_of(model_, *model_.graph);
        for (const Friction& friction : model_.frictions)
            scope_.insert_or_assign(friction.name, model_.symbol(friction.name));
        for (const Slide& slide : model_.slides)
            if (!slide.control.empty())
                scope_.insert_or_assign(slide.control, model_.symbol(slide.control));
        drawing_scope_ = scope_of(model_, *drawing_graph_);
    }

    /// Reads a number or the text of an expression. A mistake is noted, and a placeholder number returned.
    Expression expression(const TomlEntry& entry);
    /// Reads the same for a drawing and returns its text: the graph of the model stays as it is.
    std::string expression_text(const TomlEntry& entry);
    /// Reads a finite number.
    double number(const TomlEntry& entry);
    /// Reads conditions. Wrong ones are noted and left out.
    std::vector<Condition> conditions(const TomlEntry& entry);
    /// A key of a table, and what reads its value.
    struct Part {
        std::string_view key;
        std::function<void(const TomlEntry&)> read;
    };
    /// Reads the parts of a table in the order of the file. @throws InputErrors for keys that are not among them
    void read_parts(const TomlEntry& entry, std::initializer_list<Part> parts) const;
    /// The same where a single value may stand for a table with the first key only.
    void read_value_or_parts(const TomlEntry& entry, std::initializer_list<Part> parts) const;
    auto expression_into(Expression& to) {
        return [this, &to](const TomlEntry& entry) { to = expression(entry); };
    }
    auto line_into(std::string& to) const {
        return [this, &to](const TomlEntry& entry) { to = reader_.line(entry); };
    }
    auto text_into(std::string& to) const {
        return [this, &to](const TomlEntry& entry) { to = reader_.string(entry); };
    }
    /// @param to receives the index of the item that a string names
    template <typename Index, typename Item>
    auto index_into(Index& to, const std::vector<Item>& items, const char* kind) {
        return [this, &to, &items, kind](const TomlEntry& entry) { to = index(entry, items, kind); };
    }
    /// Reads a map of states; states that are not mentioned are unchanged.
    StateMap state_map(const std::vector<TomlEntry>& entries);
    /// Returns the identity map. To be called when all states have their names.
    const StateMap& identity();

    /// Returns the index of a string among the choices.
    std::size_t choice(const TomlEntry& entry, const std::vector<std::string>& choices) const;
    /// Returns the index of the item that a string names.
    template <typename Item>
    std::size_t index(const TomlEntry& entry, const std::vector<Item>& items, const char* kind) {
        places_.set(entry.path, reader_.place(*entry.node));
        return find(reader_.string(entry), reader_.place(*entry.node), items, kind);
    }
    /// Returns the index of the item that a key names.
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
    /// Indices of items by name. Items may be appended between calls; known ones keep their names.
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

    Scope scope_, drawing_scope_;
    std::shared_ptr<Graph> drawing_graph_ = Graph::create();
    StateMap identity_;
    std::map<std::string, NamePlaces, std::less<>> name_places_; ///< for each kind of item
};

} // namespace graze
