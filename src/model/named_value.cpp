#include "graze/model/named_value.hpp"

#include "base/letter_case.hpp"
#include "graze/base/trimmed.hpp"
#include "graze/symbolic/function.hpp"
#include "model/model_expressions.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace {

constexpr std::string_view blanks = " \t\n";

/// True for texts that programs print for NaN and infinity.
bool is_not_a_finite_number(std::string_view text) {
    std::string word;
    for (const char c : trimmed(text, blanks))
        if (c != '+' && c != '-')
            word += c;
    word = in_small_letters(word);
    return word == "nan" || word == "inf" || word == "infinity";
}

} // namespace

NamedValue named_value(const Model& model, const std::string& text, const Place& place) {
    const auto state = model.find_state(text), parameter = state ? std::nullopt : model.find_parameter(text);
    // Tables ask for each state by name: this avoids the copy of the model that expressions need.
    if (state)
        return {text, model.states[*state].unit, model.states[*state].text, Graph::create()->symbol(text)};
    if (parameter && !model.parameters[*parameter].expression)
        return {text, model.parameters[*parameter].unit, model.parameters[*parameter].text,
                Graph::create()->symbol(text)};
    Model scratch = model;
    if (const auto index = model.find_quantity(text)) {
        const Quantity& quantity = model.quantities[*index];
        return {quantity.name, quantity.unit, quantity.text, scratch.expand(quantity.value)};
    }
    Scope scope = scope_of(scratch);
    for (const Quantity& quantity : scratch.quantities)
        scope.emplace(quantity.name, quantity.value);
    NamedValue result{text, "", "", {}};
    result.value = scratch.expand(parse_expression(*scratch.graph, text, scope, place));
    if (parameter) {
        result.unit = model.parameters[*parameter].unit;
        result.text = model.parameters[*parameter].text;
    }
    for (const Definition& definition : model.definitions)
        if (definition.name == text)
            result.text = definition.text;
    return result;
}

bool are_same_expression(const Model& model, const std::string& one, const std::string& other) {
    Model scratch = model;
    const Scope scope = scope_of(scratch);
    const auto expanded = [&](const std::string& text) {
        return scratch.expand(parse_expression(*scratch.graph, text, scope));
    };
    try {
        return expanded(one) == expanded(other);
    } catch (const InputError&) {
        return false;
    }
}

double value_of_text(const Model& model, std::string_view text, const Place& place) {
    if (is_not_a_finite_number(text))
        throw InputError(place, fmt::format("'{}' is not a finite number", trimmed(text, blanks)),
                         "give a finite number");
    Model scratch = model;
    Scope scope;
    for (const Parameter& parameter : scratch.parameters)
        scope.emplace(parameter.name, scratch.symbol(parameter.name));
    const Expression expression = scratch.expand(parse_expression(*scratch.graph, text, scope, place));
    const double value = Function(scratch.parameter_symbols(), {{expression}})(scratch.parameter_values())[0];
    if (!std::isfinite(value))
        throw InputError(place, fmt::format("'{}' has no finite value", trimmed(text, blanks)),
                         "look for a division by zero, or a root or logarithm of a number that is not positive");
    return value;
}

namespace {

/// The place of a text that is given as the value of an option.
Place place_of(std::string_view text, const std::string& option) {
    return {fmt::format("{} {}", option, text), 1, 1};
}

} // namespace

NamedValue requested_quantity(const Model& model, const std::string& text, const std::string& option) {
    return named_value(model, text, place_of(text, option));
}

double value_of(const Model& model, std::string_view text, const std::string& option) {
    return value_of_text(model, text, place_of(text, option));
}

} // namespace graze
