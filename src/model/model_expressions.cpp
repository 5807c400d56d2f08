#include "model/model_expressions.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

enum class Role {
    general,       ///< may contain anything
    in_parameters, ///< may contain parameters only
    unused,        ///< nothing asks for it
};

/// Visits all expressions of a model, in the order of the file.
/// @param visit is called with an expression, its role, and a function that makes its path (which few want)
template <class AnyModel, class Visit>
void walk(AnyModel& model, const Visit& visit) {
    const auto visit_each_state = [&](auto& expressions, const auto& prefix) {
        for (std::size_t i = 0; i < expressions.size(); ++i)
            visit(expressions[i], Role::general, [&] { return prefix() + "." + model.states[i].name; });
    };
    const auto visit_optional = [&](auto& expression, const auto& path) {
        if (expression)
            visit(*expression, Role::in_parameters, path);
    };
    for (auto& parameter : model.parameters)
        visit_optional(parameter.expression, [&] { return "parameters." + parameter.name + ".value"; });
    for (auto& state : model.states) {
        visit(state.initial, Role::in_parameters, [&] { return "states." + state.name + ".initial"; });
        visit_optional(state.period, [&] { return "states." + state.name + ".period"; });
    }
    for (auto& definition : model.definitions)
        visit(definition.value, Role::general, [&] { return "definitions." + definition.name + ".value"; });
    for (auto& mode : model.modes)
        visit_each_state(mode.rates, [&] { return "modes." + mode.name + ".rates"; });
    for (auto& event : model.events)
        visit(event.function, Role::general, [&] { return "events." + event.name + ".function"; });
    for (auto& jump : model.jumps)
        visit_each_state(jump.map, [&] { return "jumps." + jump.name; });
    for (std::size_t i = 0; i < model.transitions.size(); ++i)
        for (std::size_t k = 0; k < model.transitions[i].next.size(); ++k)
            for (auto& condition : model.transitions[i].next[k].when)
                visit(condition.function, Role::general,
                      [&] { return fmt::format("transitions.{}.next.{}.when", i + 1, k + 1); });
    for (auto& section : model.sections) {
        visit(section.function, section.state ? Role::unused : Role::general,
              [&] { return "sections." + section.name + ".function"; });
        visit(section.value, section.state ? Role::in_parameters : Role::unused,
              [&] { return "sections." + section.name + ".value"; });
    }
    for (auto& symmetry : model.symmetries)
        visit_each_state(symmetry.map, [&] { return "symmetries." + symmetry.name + ".map"; });
    for (auto& quantity : model.quantities)
        visit(quantity.value, Role::general, [&] { return "quantities." + quantity.name + ".value"; });
}

} // namespace

std::vector<ModelExpression> model_expressions(const Model& model) {
    std::vector<ModelExpression> result;
    walk(model, [&](const Expression& expression, Role role, const auto& path) {
        if (role != Role::unused)
            result.push_back({path(), expression, role == Role::in_parameters});
    });
    return result;
}

void visit_expressions(Model& model, const std::function<void(Expression&)>& visit) {
    walk(model, [&](Expression& expression, Role, const auto&) { visit(expression); });
}

} // namespace graze
