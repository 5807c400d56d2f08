#include "graze/model/driven_parameter.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/model_completion.hpp"
#include "model/model_expressions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <vector>

namespace graze {

namespace {

bool is_taken(const Model& model, const std::string& name) {
    return model.find_parameter(name) || model.find_state(name) || find_named(model.definitions, name) ||
           model.find_quantity(name);
}

std::string free_name(const Model& model, std::string name) {
    while (is_taken(model, name))
        name += "_";
    return name;
}

bool contains(const Expression& expression, const Expression& symbol) {
    const std::vector<Expression> symbols = symbols_of(std::vector<Expression>{expression});
    return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end();
}

/// Refuses the parameter if a quantity that must stay constant depends on it.
void require_fixed(Model& model, const Expression& expression, const Expression& symbol, const std::string& what) {
    if (!expression.empty() && contains(model.expand(expression), symbol))
        throw InputError(
            fmt::format("{} depends on '{}', which therefore cannot change in time", what, to_string(symbol)),
            "choose another parameter");
}

void require_drivable(Model& model, const Expression& symbol) {
    for (const State& state : model.states)
        if (state.period)
            require_fixed(model, *state.period, symbol, fmt::format("the period of '{}'", state.name));
    for (const Section& section : model.sections)
        if (section.state)
            require_fixed(model, section.value, symbol, fmt::format("the place of the section '{}'", section.name));
}

/// Returns the driven value of the parameter, and the resulting values of parameters that depend on it.
std::vector<Replacement> replacements_for(Model& model, const Expression& symbol, const Expression& value) {
    const std::vector<Replacement> own{{symbol, value}};
    std::vector<Replacement> all = own;
    const std::vector<Parameter> parameters = model.parameters;
    for (const Parameter& one : parameters) {
        if (!one.expression)
            continue;
        const Expression expanded = model.expand(*one.expression);
        if (contains(expanded, symbol))
            all.emplace_back(model.symbol(one.name), substitute(expanded, own));
    }
    return all;
}

/// Replaces symbols in all expressions of states; parameters and initial states are left unchanged.
void replace_everywhere(Model& model, const std::vector<Replacement>& replacements) {
    const std::vector<Parameter> parameters = model.parameters;
    const std::vector<State> states = model.states;
    visit_expressions(model, [&](Expression& one) {
        if (!one.empty())
            one = substitute(one, replacements);
    });
    model.parameters = parameters;
    model.states = states;
}

} // namespace

DrivenParameter drive_parameter(const Model& model, std::string_view parameter, DriveKind kind) {
    model.independent_parameter(parameter); // throws for other names
    DrivenParameter driven;
    driven.source_ = std::make_shared<Model>(model);
    driven.parameter_ = std::string(parameter);
    // Motions along surfaces depend on all rates: they are derived again.
    driven.model = is_as_declared(model) ? declared_model(model) : model;
    Model& made = driven.model;
    made.symmetries.clear();
    const Expression symbol = made.symbol(parameter);
    require_drivable(made, symbol);

    const bool wave = kind == DriveKind::wave;
    driven.state = free_name(made, driven.parameter_ + (wave ? "_phase" : "_shift"));
    driven.rate = free_name(made, driven.parameter_ + (wave ? "_frequency" : "_rate"));
    made.parameters.push_back({.name = driven.rate, .value = 0});
    const Expression state = made.symbol(driven.state);
    driven.value = symbol + state;
    if (wave) {
        driven.amplitude = free_name(made, driven.parameter_ + "_amplitude");
        made.parameters.push_back({.name = driven.amplitude, .value = 0});
        driven.value = symbol + made.symbol(driven.amplitude) * sin(state);
    }
    replace_everywhere(made, replacements_for(made, symbol, driven.value));
    State added{.name = driven.state, .initial = made.number(0)};
    if (wave)
        added.period = made.number(2 * std::numbers::pi);
    made.states.push_back(std::move(added));
    for (Mode& mode : made.modes)
        if (!mode.rates.empty())
            mode.rates.push_back(made.symbol(driven.rate));
    for (Jump& jump : made.jumps)
        if (!jump.map.empty())
            jump.map.push_back(state);
    made.complete();
    made.validate();
    return driven;
}

Expression DrivenParameter::of(const Expression& expression) const {
    Model source = *source_, scratch = model;
    const Expression plain = source.expand(expression);
    source.require_known(source.inputs(), std::vector<Expression>{plain});
    const Expression here = scratch.expand(plain); // has nothing left to expand; this adopts it into the graph
    return substitute(here, std::vector<Replacement>{{scratch.symbol(parameter_), scratch.expand(value)}});
}

} // namespace graze
