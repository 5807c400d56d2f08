#include "graze/symbolic/linearisation.hpp"

#include "symbolic/linear_graph.hpp"
#include "symbolic/slope.hpp"
#include "symbolic/subgraph.hpp"

#include <algorithm>
#include <queue>
#include <stdexcept>
#include <unordered_set>
#include <utility>

namespace graze {

namespace {

/// Which nodes of a subgraph have one of the first variables in them.
std::vector<bool> nodes_with(const Subgraph& part, const SymbolIndex& variables, std::size_t first) {
    std::vector<bool> found(part.items.size());
    for (std::size_t position = 0; position < found.size(); ++position) {
        const Subgraph::Item& item = part.items[position];
        const Operation operation = part.node(item).operation;
        if (operation == Operation::symbol) {
            const auto place = variables.find(item.index);
            found[position] = place && *place < first;
        } else {
            const int operands = arity(operation);
            found[position] = (operands >= 1 && found[item.left]) || (operands == 2 && found[item.right]);
        }
    }
    return found;
}

/// Finds the derivatives of nodes of a subgraph by sources: variables, and other nodes that are intermediates. It goes
/// from the node down to the sources, so that a row takes the time of its size, however many sources it has, and so
/// that its coefficients share what they have in common.
class RowBuilder {
public:
    RowBuilder(const Subgraph& part, const SymbolIndex& variables, std::span<const std::uint32_t> intermediates)
        : part_(part), reaches_(nodes_with(part, variables, variables.size())), sources_(part.items.size(), none),
          weights_(part.items.size()) {
        for (std::size_t position = 0; position < sources_.size(); ++position)
            if (part.node(part.items[position]).operation == Operation::symbol)
                if (const auto place = variables.find(part.items[position].index))
                    sources_[position] = *place;
        for (std::size_t i = 0; i < intermediates.size(); ++i)
            sources_[intermediates[i]] = variables.size() + i;
    }

    /// @param own whether it is the row of an intermediate, at that position, rather than of a function
    void append(std::vector<LinearEntry>& entries, std::size_t row, std::uint32_t position, bool own) {
        const auto before = static_cast<std::ptrdiff_t>(entries.size());
        std::priority_queue<std::uint32_t> pending; // nodes before their operands
        pending_ = &pending;
        add(position, part_.graph->number(1));
        while (!pending.empty()) {
            const std::uint32_t next = pending.top();
            pending.pop();
            const Expression weight = std::exchange(weights_[next], {});
            if (weight.is_number(0))
                continue;
            if (sources_[next] == none || (own && next == position))
                pass_on(next, weight);
            else
                entries.push_back({row, sources_[next], weight});
        }
        std::sort(entries.begin() + before, entries.end(),
                  [](const LinearEntry& one, const LinearEntry& other) { return one.source < other.source; });
    }

private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    void add(std::uint32_t position, const Expression& weight) {
        if (!reaches_[position])
            return;
        Expression& sum = weights_[position];
        if (sum.empty())
            pending_->push(position);
        sum = sum.empty() ? weight : sum + weight;
    }

    /// Products are formed as in derivatives of transform.hpp: whatever these are finite for, the weights are, too.
    void pass_on(std::uint32_t position, const Expression& weight) {
        const Subgraph::Item& item = part_.items[position];
        const Operation operation = part_.node(item).operation;
        const Expression value = part_.expression(item), left = part_.expression(part_.items[item.left]);
        if (arity(operation) == 1) {
            add(item.left, slope_of(operation, value, left) * weight);
            return;
        }
        const Expression right = part_.expression(part_.items[item.right]);
        if (reaches_[item.left]) // what is not needed is not formed
            add(item.left, to_left(operation, left, right, weight));
        if (reaches_[item.right])
            add(item.right, to_right(operation, value, left, right, weight));
    }
    static Expression to_left(Operation operation, const Expression& left, const Expression& right,
                              const Expression& weight) {
        switch (operation) {
        case Operation::multiply:
            return weight * right;
        case Operation::divide:
            return weight / right;
        case Operation::power:
            return right * pow(left, right - 1) * weight;
        default:
            return weight;
        }
    }
    static Expression to_right(Operation operation, const Expression& value, const Expression& left,
                               const Expression& right, const Expression& weight) {
        switch (operation) {
        case Operation::subtract:
            return -weight;
        case Operation::multiply:
            return left * weight;
        case Operation::divide:
            return -(value * weight) / right;
        case Operation::power:
            return value * log(left) * weight;
        default:
            return weight;
        }
    }

    const Subgraph& part_;
    std::vector<bool> reaches_; ///< any variable
    std::vector<std::size_t> sources_;
    std::vector<Expression> weights_; ///< derivatives of the row by nodes
    std::priority_queue<std::uint32_t>* pending_ = nullptr;
};

/// Takes out intermediates that nothing is made of, or that do not change, as where derivatives have cancelled.
void remove_idle(Linearisation& result) {
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
    const std::vector<bool> moves = nodes_with(part, variables, states);
    for (std::size_t i = 0; i < entries.size(); ++i)
        entries[i].varies = moves[part.roots[i]];
}

Linearisation with_intermediates(const Subgraph& part, const SymbolIndex& variables, std::size_t states,
                                 std::span<const std::uint32_t> intermediates) {
    Linearisation result{variables.size(), part.roots.size(), intermediates.size(), {}};
    RowBuilder rows(part, variables, intermediates);
    for (std::size_t i = 0; i < intermediates.size(); ++i)
        rows.append(result.entries, i, intermediates[i], true);
    for (std::size_t root = 0; root < part.roots.size(); ++root)
        rows.append(result.entries, intermediates.size() + root, part.roots[root], false);
    remove_idle(result);
    mark_varying(result.entries, variables, states);
    return result;
}

/// Of an operation on series, given which of its operands move.
std::size_t cost_of(Operation operation, bool left_moves, bool right_moves) {
    switch (operation) {
    case Operation::add:
    case Operation::subtract:
    case Operation::negate:
        return Linearisation::constant_cost;
    case Operation::multiply:
        return left_moves && right_moves ? Linearisation::varying_cost : Linearisation::constant_cost;
    case Operation::divide:
        return right_moves ? Linearisation::varying_cost : Linearisation::constant_cost;
    default:
        return Linearisation::varying_cost;
    }
}

/// Of directions in which no parameter changes, with what coefficients take besides functions.
std::size_t cost_in_states(Linearisation linear, const Subgraph& functions, const SymbolIndex& variables,
                           std::size_t states, std::size_t directions) {
    std::erase_if(linear.entries,
                  [&](const LinearEntry& entry) { return entry.source >= states && entry.source < linear.variables; });
    std::unordered_set<NodeIndex> known;
    for (const Subgraph::Item& item : functions.items)
        known.insert(item.index);
    const Subgraph part = subgraph_of(coefficients_of(linear.entries));
    const std::vector<bool> moves = nodes_with(part, variables, states);
    std::size_t cost = directions * linear.cost();
    for (std::size_t position = 0; position < part.items.size(); ++position) {
        const Subgraph::Item& item = part.items[position];
        const Operation operation = part.node(item).operation;
        if (moves[position] && arity(operation) > 0 && !known.contains(item.index))
            cost += cost_of(operation, moves[item.left], arity(operation) == 2 && moves[item.right]);
    }
    return cost;
}

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
        throw std::invalid_argument("there are more states than variables");
    constexpr std::size_t most_directions = 1000000;
    if (directions == 0 || directions > most_directions)
        throw std::invalid_argument("the number of directions is not between 1 and a million");
    Linearisation result{variables.size(), functions.size(), 0, {}};
    const Subgraph part = subgraph_of(functions);
    if (!part.graph)
        return result;
    if (!variables.are_of(part.graph))
        throw std::invalid_argument("a variable belongs to another graph than the functions");
    LinearGraph graph(part, nodes_with(part, variables, states), directions);
    graph.reduce();
    const bool may_be_too_many = graph.drop_useless();
    result = with_intermediates(part, variables, states, graph.remaining());
    if (result.intermediates == 0 || !may_be_too_many)
        return result;
    // Derivatives that cancel are not foreseen, and leave fewer products where nothing is between them.
    Linearisation plain = with_intermediates(part, variables, states, {});
    const auto cost = [&](const Linearisation& one) {
        return cost_in_states(one, part, variables, states, directions);
    };
    return cost(plain) <= cost(result) ? plain : result;
}

} // namespace graze
