#include "graze/flow/compiled_model.hpp"

#include "graze/symbolic/transform.hpp"
#include "symbolic/subgraph.hpp"

#include <algorithm>

namespace graze {

CompiledModel::CompiledModel(const Model& model, std::span<const Expression> observed)
    : model_(model), observed_(observed.size()) {
    model_.validate();
    inputs_ = model_.state_symbols();
    const auto parameter_symbols = model_.parameter_symbols();
    parameters_ = parameter_symbols.size();
    inputs_.insert(inputs_.end(), parameter_symbols.begin(), parameter_symbols.end());

    compile_modes(observed);
    compile_jumps();
    compile_transitions();

    std::vector<Expression> periods, initial;
    for (const State& state : model_.states) {
        periods.push_back(state.period ? *state.period : model_.graph->number(0));
        initial.push_back(state.initial);
    }
    periods_ = Function(parameter_symbols, model_.expand(periods));
    initial_ = Function(parameter_symbols, model_.expand(initial));
    workspace_ = std::max({workspace_, periods_.workspace(), initial_.workspace()});
}

Function CompiledModel::function_of(std::span<const Expression> outputs) {
    Function function(inputs_, model_.expand(outputs));
    workspace_ = std::max(workspace_, function.workspace());
    return function;
}

/// Row by row: functions x variables.
std::vector<Expression> CompiledModel::derivatives(std::span<const Expression> functions,
                                                   std::span<const Expression> variables) const {
    const auto expanded = model_.expand(functions);
    std::vector<std::vector<Expression>> columns;
    for (const Expression& variable : variables)
        columns.push_back(differentiate(expanded, variable));
    std::vector<Expression> rows;
    for (std::size_t row = 0; row < functions.size(); ++row)
        for (const auto& column : columns)
            rows.push_back(column[row]);
    return rows;
}

/// What stands under each root or power in some expressions, followed by the exponent.
std::vector<Expression> CompiledModel::roots_in(std::span<const Expression> expressions) const {
    const auto expanded = model_.expand(expressions);
    const Subgraph part = subgraph_of(expanded);
    std::vector<Expression> roots;
    for (const Subgraph::Item& item : part.items) {
        const Operation operation = part.node(item).operation;
        if (operation != Operation::sqrt && operation != Operation::power)
            continue;
        roots.push_back(part.expression(part.items[item.left]));
        roots.push_back(operation == Operation::sqrt ? model_.graph->number(0.5)
                                                     : part.expression(part.items[item.right]));
    }
    return roots;
}

void CompiledModel::compile_modes(std::span<const Expression> observed) {
    const auto states = model_.state_symbols();
    const auto parameters = model_.parameter_symbols();
    for (std::size_t m = 0; m < model_.modes.size(); ++m) {
        const Mode& mode = model_.modes[m];
        std::vector<Expression> outputs;
        CompiledMode compiled;
        for (const std::size_t event : mode.watched) {
            const Transition* transition = model_.find_transition(m, event);
            if (!transition)
                continue; // a section that leads nowhere: the motion passes through
            outputs.push_back(model_.events[event].function);
            compiled.watched.push_back(event);
            compiled.transitions.push_back(static_cast<std::size_t>(transition - model_.transitions.data()));
        }
        compiled.events = function_of(outputs);
        compiled.event_gradients = function_of(derivatives(outputs, states));
        outputs.insert(outputs.end(), observed.begin(), observed.end());
        compiled.tape = compile_tape(states, parameters, model_.expand(mode.rates), model_.expand(outputs));
        compiled.rates = function_of(mode.rates);
        std::vector<Expression> all = mode.rates;
        all.insert(all.end(), outputs.begin(), outputs.end());
        compiled.evidence = function_of(all);
        compiled.polynomial = std::all_of(compiled.tape.degrees.begin(), compiled.tape.degrees.end(),
                                          [](std::uint32_t degree) { return degree != Tape::unbounded; });
        compiled.has_roots = std::any_of(compiled.tape.code.begin(), compiled.tape.code.end(), [](const auto& one) {
            return one.operation == SeriesOperation::sqrt || one.operation == SeriesOperation::power_constant;
        });
        compiled.roots = function_of(roots_in(mode.rates));
        modes_.push_back(std::move(compiled));
    }
}

void CompiledModel::compile_jumps() {
    for (const Jump& jump : model_.jumps) {
        CompiledJump compiled;
        const auto states = model_.state_symbols();
        const auto map = jump.map.empty() ? states : model_.expand(jump.map); // the identity may be left empty
        compiled.identity = std::equal(map.begin(), map.end(), states.begin(), states.end());
        compiled.map = function_of(map);
        compiled.jacobian = function_of(derivatives(map, inputs_));
        jumps_.push_back(std::move(compiled));
    }
}

void CompiledModel::compile_transitions() {
    for (const Transition& transition : model_.transitions) {
        CompiledTransition compiled;
        compiled.jump = transition.jump;
        for (const Alternative& alternative : transition.next) {
            std::vector<Expression> conditions;
            CompiledAlternative way;
            for (const Condition& condition : alternative.when) {
                conditions.push_back(condition.function);
                way.strict.push_back(condition.strict);
            }
            way.conditions = function_of(conditions);
            way.mode = alternative.mode;
            compiled.next.push_back(std::move(way));
        }
        transitions_.push_back(std::move(compiled));
    }
}

} // namespace graze
