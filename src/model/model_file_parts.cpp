#include "model/model_file_parts.hpp"

#include "graze/base/input_error.hpp"
#include "model/model_validate.hpp"
#include "model/written_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace graze {

/// Returns an error in the value of a string (parsed as if it were a file of its own) with its place in this file.
InputError ModelParts::inside(const TomlEntry& entry, const std::string& text, const InputError& error) const {
    const std::size_t offset = SourceText(text, "").position(error.place());
    return {source_.inside_string(reader_.place(*entry.node), offset), error.problem(), error.remedy()};
}

/// Parses a string with `parse(text, place)` and records its place.
template <typename Parse>
auto ModelParts::parse_string(const TomlEntry& entry, Parse parse) {
    const std::string text = reader_.string(entry);
    places_.set_string(entry.path, reader_.place(*entry.node), text);
    try {
        return parse(text, Place{source_.file(), 1, 1});
    } catch (const InputError& error) {
        throw inside(entry, text, error);
    }
}

Expression ModelParts::expression(const TomlEntry& entry) {
    Expression result;
    return mistakes_.attempt([&] { result = parsed_expression(entry); }) ? result : model_.graph->number(1);
}

Expression ModelParts::parsed_expression(const TomlEntry& entry) {
    if (entry.node->is_number())
        return model_.graph->number(number(entry));
    if (!entry.node->is_string())
        reader_.fail_type(entry, "a number or an expression");
    return parse_string(entry, [&](const std::string& text, const Place& place) {
        return parse_expression(*model_.graph, text, scope_, place);
    });
}

std::string ModelParts::expression_text(const TomlEntry& entry) {
    std::string result = "0";
    mistakes_.attempt([&] {
        if (entry.node->is_number())
            result = number_text(number(entry));
        else if (!entry.node->is_string())
            reader_.fail_type(entry, "a number or an expression");
        else
            result = parse_string(entry, [&](const std::string& text, const Place& place) {
                return written_text(parse_expression(*drawing_graph_, text, drawing_scope_, place));
            });
    });
    return result;
}

double ModelParts::number(const TomlEntry& entry) {
    places_.set(entry.path, reader_.place(*entry.node));
    const toml::value<std::int64_t>* integer = entry.node->as_integer();
    const double value =
        integer != nullptr ? static_cast<double>(integer->get()) : entry.node->as_floating_point()->get();
    if (!std::isfinite(value))
        throw InputError(reader_.place(*entry.node), fmt::format("{} is {}", entry.path, value),
                         "give a finite number");
    return value;
}

std::vector<Condition> ModelParts::conditions(const TomlEntry& entry) {
    std::vector<Condition> result;
    mistakes_.attempt([&] {
        result = parse_string(entry, [&](const std::string& text, const Place& place) {
            return parse_conditions(*model_.graph, text, scope_, place);
        });
    });
    return result;
}

void ModelParts::read_parts(const TomlEntry& entry, std::initializer_list<Part> parts) const {
    std::vector<std::string> keys;
    for (const Part& part : parts)
        keys.emplace_back(part.key);
    for (const TomlEntry& one : reader_.entries(reader_.table(entry), entry.path, keys))
        std::ranges::find(parts, one.name, &Part::key)->read(one);
}

void ModelParts::read_value_or_parts(const TomlEntry& entry, std::initializer_list<Part> parts) const {
    if (entry.node->is_table())
        return read_parts(entry, parts);
    if (!entry.node->is_number() && !entry.node->is_string())
        reader_.fail_type(entry, "a number, an expression or a table");
    const std::string key(parts.begin()->key);
    parts.begin()->read({key, entry.path + "." + key, entry.place, entry.node});
}

const StateMap& ModelParts::identity() {
    if (identity_.empty())
        identity_ = model_.state_symbols();
    return identity_;
}

StateMap ModelParts::state_map(const std::vector<TomlEntry>& entries) {
    StateMap result = identity();
    for (const TomlEntry& entry : entries)
        result[key_index(entry, model_.states, "state")] = expression(entry);
    return result;
}

std::size_t ModelParts::choice(const TomlEntry& entry, const std::vector<std::string>& choices) const {
    const std::string text = reader_.string(entry);
    const auto found = std::find(choices.begin(), choices.end(), text);
    if (found == choices.end())
        throw InputError(reader_.place(*entry.node), fmt::format("{} cannot be '{}'", entry.path, text),
                         fmt::format("choose from {}", fmt::join(choices, ", ")));
    return static_cast<std::size_t>(found - choices.begin());
}

void ModelParts::fail_name(const std::string& name, const Place& place, const std::vector<std::string>& names,
                           const char* kind) {
    throw InputError(place, fmt::format("there is no {} '{}'", kind, name), name_remedy(name, names));
}

void ModelParts::fail_missing(const TomlEntry& entry, const char* what, const char* key) const {
    throw InputError(entry.place, fmt::format("{} has no {}", entry.path, what), fmt::format("add {} = ...", key));
}

} // namespace graze
