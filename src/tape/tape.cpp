#include "graze/tape/tape.hpp"

#include "graze/base/input_error.hpp"

#include "symbolic/subgraph.hpp"
#include "tape/series_builder.hpp"
#include "tape/tape_analysis.hpp"

#include <unordered_map>
#include <utility>

namespace graze {

namespace {

std::vector<Expression> joined(std::span<const Expression> one, std::span<const Expression> other) {
    std::vector<Expression> all(one.begin(), one.end());
    all.insert(all.end(), other.begin(), other.end());
    return all;
}

std::vector<Expression> values_of(std::span<const DeferredExpression> deferred) {
    std::vector<Expression> values;
    for (const DeferredExpression& one : deferred)
        values.push_back(one.value);
    return values;
}

using Symbols = std::unordered_map<NodeIndex, LinearForm>;

/// Returns the registers of the states and the constants of the parameters.
Symbols symbols(SeriesBuilder& builder, std::span<const Expression> states, std::span<const Expression> parameters) {
    Symbols forms;
    std::uint32_t index = 0;
    for (const Expression& state : states)
        forms.emplace(state.index(), builder.series(index++));
    index = 0;
    for (const Expression& parameter : parameters)
        forms.emplace(parameter.index(), builder.constant(index++));
    return forms;
}

/// Returns the forms of all expressions of a subgraph. A form that is used only once is moved, not copied.
std::vector<LinearForm> compile(SeriesBuilder& builder, const Subgraph& subgraph, const Symbols& symbols) {
    std::vector<std::uint32_t> uses(subgraph.items.size(), 0);
    for (const Subgraph::Item& item : subgraph.items) {
        const int operands = arity(subgraph.node(item).operation);
        if (operands > 0)
            ++uses[item.left];
        if (operands > 1)
            ++uses[item.right];
    }
    for (const std::uint32_t root : subgraph.roots)
        ++uses[root];

    std::vector<LinearForm> forms(subgraph.items.size());
    const auto operand = [&](std::uint32_t position) {
        return uses[position] == 1 ? std::move(forms[position]) : forms[position];
    };
    for (std::size_t i = 0; i < subgraph.items.size(); ++i) {
        const Subgraph::Item& item = subgraph.items[i];
        const Node& node = subgraph.node(item);
        if (node.operation == Operation::number) {
            forms[i] = builder.number(node.value);
        } else if (node.operation == Operation::symbol) {
            const auto found = symbols.find(item.index);
            if (found == symbols.end())
                throw InputError("'" + subgraph.graph->symbol_name(node) + "' is neither a state nor a parameter", "");
            forms[i] = found->second;
        } else {
            LinearForm left = operand(item.left);
            LinearForm right = arity(node.operation) == 2 ? operand(item.right) : LinearForm{};
            forms[i] = builder.apply(node.operation, std::move(left), std::move(right));
        }
        if (uses[i] > 1)
            forms[i] = builder.shared(std::move(forms[i]));
    }
    return forms;
}

void check(const Subgraph& subgraph, std::span<const Expression> symbols) {
    for (const Expression& symbol : symbols)
        if (symbol.empty() || !symbol.is_symbol() || (subgraph.graph != nullptr && symbol.graph() != subgraph.graph))
            throw InputError("states and parameters must be symbols of the graph of the expressions", "");
}

} // namespace

Tape compile_tape(std::span<const Expression> states, std::span<const Expression> parameters,
                  std::span<const Expression> rates, std::span<const Expression> outputs,
                  std::span<const DeferredExpression> deferred) {
    if (states.size() != rates.size())
        throw InputError("there must be as many rates as states", "");
    const Subgraph subgraph = subgraph_of(joined(rates, outputs)), behind = subgraph_of(values_of(deferred));
    for (const Subgraph* part : {&subgraph, &behind}) {
        check(*part, states);
        check(*part, parameters);
    }

    Tape tape;
    tape.states = static_cast<std::uint32_t>(states.size());
    tape.parameters = static_cast<std::uint32_t>(parameters.size());
    SeriesBuilder builder(tape.states, tape.parameters);
    const Symbols known = symbols(builder, states, parameters);
    const std::vector<LinearForm> forms = compile(builder, subgraph, known);
    std::vector<bool> rate_is_zero;
    for (std::size_t i = 0; i < subgraph.roots.size(); ++i) {
        const Tape::Location location = builder.location(forms[subgraph.roots[i]]);
        if (i < rates.size()) {
            tape.rates.push_back(location);
            rate_is_zero.push_back(location.constant && builder.constants().is(location.index, 0));
        } else {
            tape.outputs.push_back(location);
        }
    }
    // Deferred expressions are compiled separately: they reuse existing registers, but do not change the code for rates
    // and outputs.
    builder.prefer_reciprocals();
    const std::vector<LinearForm> more = compile(builder, behind, known);
    std::vector<std::uint32_t> groups;
    for (std::size_t i = 0; i < deferred.size(); ++i) {
        tape.deferred.push_back(builder.location(more[behind.roots[i]]));
        groups.push_back(deferred[i].group);
    }
    builder.move_to(tape);
    find_degrees(tape, rate_is_zero);
    remove_unneeded(tape);
    separate_deferred_code(tape, groups);
    builder.constants().move_to(tape);
    return tape;
}

} // namespace graze
