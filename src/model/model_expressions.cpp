#include "model/model_expressions.hpp"

#include <fmt/format.h>

namespace graze {

std::vector<ModelExpression> model_expressions(const Model& model) {
    std::vector<ModelExpression> result;
    const auto add_each_state = [&](const std::string& path, const std::vector<Expression>& expressions) {
        for (std::size_t i = 0; i < expressions.size(); ++i)
            result.push_back({path + "." + model.states[i].name, expressions[i]});
    };
    for (const Parameter& parameter : model.parameters)
        if (parameter.expression)
            result.push_back({"parameters." + parameter.name + ".value", *parameter.expression, true});
    for (const State& state : model.states) {
        result.push_back({"states." + state.name + ".initial", state.initial, true});
        if (state.period)
            result.push_back({"states." + state.name + ".period", *state.period, true});
    }
    for (const Definition& definition : model.definitions)
        result.push_back({"definitions." + definition.name + ".value", definition.value});
    for (const Mode& mode : model.modes)
        add_each_state("modes." + mode.name + ".rates", mode.rates);
    for (const Event& event : model.events)
        result.push_back({"events." + event.name + ".function", event.function});
    for (const Jump& jump : model.jumps)
        add_each_state("jumps." + jump.name, jump.map);
    for (std::size_t i = 0; i < model.transitions.size(); ++i)
        for (std::size_t k = 0; k < model.transitions[i].next.size(); ++k)
            for (const Condition& condition : model.transitions[i].next[k].when)
                result.push_back({fmt::format("transitions.{}.next.{}.when", i + 1, k + 1), condition.function});
    for (const Section& section : model.sections) {
        const std::string path = "sections." + section.name;
        if (section.state)
            result.push_back({path + ".value", section.value, true});
        else
            result.push_back({path + ".function", section.function});
    }
    for (const Symmetry& symmetry : model.symmetries)
        add_each_state("symmetries." + symmetry.name + ".map", symmetry.map);
    for (const Quantity& quantity : model.quantities)
        result.push_back({"quantities." + quantity.name + ".value", quantity.value});
    return result;
}

void visit_expressions(Model& model, const std::function<void(Expression&)>& visit) {
    const auto visit_all = [&](std::vector<Expression>& expressions) {
        for (Expression& expression : expressions)
            visit(expression);
    };
    const auto visit_optional = [&](std::optional<Expression>& expression) {
        if (expression)
            visit(*expression);
    };
    for (Parameter& parameter : model.parameters)
        visit_optional(parameter.expression);
    for (State& state : model.states) {
        visit(state.initial);
        visit_optional(state.period);
    }
    for (Definition& definition : model.definitions)
        visit(definition.value);
    for (Mode& mode : model.modes)
        visit_all(mode.rates);
    for (Event& event : model.events)
        visit(event.function);
    for (Jump& jump : model.jumps)
        visit_all(jump.map);
    for (Transition& transition : model.transitions)
        for (Alternative& alternative : transition.next)
            for (Condition& condition : alternative.when)
                visit(condition.function);
    for (Section& section : model.sections) {
        visit(section.function);
        visit(section.value);
    }
    for (Symmetry& symmetry : model.symmetries)
        visit_all(symmetry.map);
    for (Quantity& quantity : model.quantities)
        visit(quantity.value);
}

} // namespace graze
