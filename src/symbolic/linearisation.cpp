#include "graze/symbolic/linearisation.hpp"

#include "graze/base/input_error.hpp"

#include "symbolic/linear_graph.hpp"
#include "symbolic/linear_rows.hpp"
#include "symbolic/subgraph.hpp"

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace graze {

namespace {

/// Removes intermediates that are constant (their derivatives have cancelled) or that nothing depends on.
void remove_unused_intermediates(Linearisation& result) {
    std::vector<bool> changes(result.intermediates), used(result.intermediates);
    const auto intermediate = [&](const LinearEntry& entry) { return entry.source - result.variables; };
    std::erase_if(result.entries, [&](const LinearEntry& entry) {
        if (entry.source >= result.variables && !changes[intermediate(entry)])
            return true;
        if (entry.row < result.intermediates)
            changes[entry.row] = true;
        return false;
    });
    for (std::size_t i = result.entries.size(); i-- > 0;)
        if (const LinearEntry& entry = result.entries[i];
            entry.source >= result.variables && (entry.row >= result.intermediates || used[entry.row]))
            used[intermediate(entry)] = true;
    std::erase_if(result.entries,
                  [&](const LinearEntry& entry) { return entry.row < result.intermediates && !used[entry.row]; });
    std::vector<std::size_t> places(result.intermediates);
    std::size_t left = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i] = left;
        left += used[i] ? 1 : 0;
    }
    for (LinearEntry& entry : result.entries) {
        if (entry.source >= result.variables)
            entry.source = result.variables + places[intermediate(entry)];
        entry.row = entry.row < result.intermediates ? places[entry.row] : entry.row - result.intermediates + left;
    }
    result.intermediates = left;
}

std::vector<Expression> coefficients_of(std::span<const LinearEntry> entries) {
    std::vector<Expression> coefficients;
    coefficients.reserve(entries.size());
    for (const LinearEntry& entry : entries)
        coefficients.push_back(entry.coefficient);
    return coefficients;
}

void mark_varying(std::vector<LinearEntry>& entries, const SymbolIndex& variables, std::size_t states) {
    const Subgraph part = subgraph_of(coefficients_of(entries));
    const std::vector<bool> has_state = nodes_with(part, variables, states);
    for (std::size_t i = 0; i < entries.size(); ++i)
        entries[i].varies = has_state[part.roots[i]];
}

/// Returns the cost of an operation on series, given which operands vary.
std::size_t cost_of_operation(Operation operation, bool left_varies, bool right_varies) {
    switch (operation) {
    case Operation::add:
    case Operation::subtract:
    case Operation::negate:
        return Linearisation::constant_cost;
    case Operation::multiply:
        return left_varies && right_varies ? Linearisation::varying_cost : Linearisation::constant_cost;
    case Operation::divide:
        return right_varies ? Linearisation::varying_cost : Linearisation::constant_cost;
    default:
        return Linearisation::varying_cost;
    }
}

/// Returns the cost of directions in state space, including the operations for coefficients that `functions` lacks.
std::size_t cost_in_states(Linearisation linear, const Subgraph& functions, const SymbolIndex& variables,
                           std::size_t states, std::size_t directions) {
    std::erase_if(linear.entries,
                  [&](const LinearEntry& entry) { return entry.source >= states && entry.source < linear.variables; });
    std::unordered_set<NodeIndex> known;
    for (const Subgraph::Item& item : functions.items)
        known.insert(item.index);
    const Subgraph part = subgraph_of(coefficients_of(linear.entries));
    const std::vector<bool> has_state = nodes_with(part, variables, states);
    std::size_t cost = directions * linear.cost();
    for (std::size_t position = 0; position < part.items.size(); ++position) {
        const Subgraph::Item& item = part.items[position];
        const Operation operation = part.node(item).operation;
        if (has_state[position] && arity(operation) > 0 && !known.contains(item.index))
            cost += cost_of_operation(operation, has_state[item.left], arity(operation) == 2 && has_state[item.right]);
    }
    return cost;
}

/// Differentiates with given intermediates and computes the cost.
class Lineariser {
public:
    Lineariser(const Subgraph& part, const SymbolIndex& variables, std::size_t states, std::size_t directions)
        : part_(part), variables_(variables), states_(states), directions_(directions) {}

    /// Differentiates in both modes and returns the cheaper result. Without intermediates, forward mode gives the
    /// entries of the sparse Jacobian, but takes time proportional to rows times their sources.
    Linearisation best_rows(std::span<const std::uint32_t> intermediates) const {
        LinearRows rows(part_, variables_, intermediates);
        Linearisation down = of_entries(rows.from_functions(), intermediates.size());
        constexpr std::size_t enough = 200000, each = 32;
        if (rows.work_from_sources() > enough + each * part_.items.size())
            return down;
        Linearisation up = of_entries(rows.from_sources(), intermediates.size());
        return cost(up) <= cost(down) ? up : down;
    }
    std::size_t cost(const Linearisation& one) const {
        return cost_in_states(one, part_, variables_, states_, directions_);
    }

private:
    Linearisation of_entries(std::vector<LinearEntry> entries, std::size_t intermediates) const {
        Linearisation result{variables_.size(), part_.roots.size(), intermediates, std::move(entries)};
        remove_unused_intermediates(result);
        mark_varying(result.entries, variables_, states_);
        return result;
    }

    const Subgraph& part_;
    const SymbolIndex& variables_;
    std::size_t states_, directions_;
};

} // namespace

std::size_t Linearisation::varying_entries() const {
    return static_cast<std::size_t>(std::ranges::count_if(entries, &LinearEntry::varies));
}

std::size_t Linearisation::cost() const {
    const std::size_t varying = varying_entries();
    return varying * varying_cost + (entries.size() - varying) * constant_cost + intermediates * intermediate_cost;
}

Linearisation linearise(std::span<const Expression> functions, const SymbolIndex& variables, std::size_t states,
                        std::size_t directions) {
    if (states > variables.size())
        throw InputError("there are more states than variables", "");
    constexpr std::size_t most_directions = 1000000;
    if (directions == 0 || directions > most_directions)
        throw InputError("the number of directions is not between 1 and a million", "");
    Linearisation result{variables.size(), functions.size(), 0, {}};
    const Subgraph part = subgraph_of(functions);
    if (!part.graph)
        return result;
    if (!variables.are_of(part.graph))
        throw InputError("a variable belongs to another graph than the functions", "");
    LinearGraph graph(part, nodes_with(part, variables, states), directions);
    graph.reduce();
    const bool may_be_too_many = graph.drop_useless();
    const Lineariser lineariser(part, variables, states, directions);
    result = lineariser.best_rows(graph.remaining());
    if (result.intermediates == 0 || !may_be_too_many)
        return result;
    // Cancelling derivatives are not foreseen by the graph; where they occur, the plain Jacobian may be cheaper.
    Linearisation plain = lineariser.best_rows({});
    return lineariser.cost(plain) <= lineariser.cost(result) ? plain : result;
}

} // namespace graze
