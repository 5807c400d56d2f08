#include "graze/symbolic/transform.hpp"

#include "graze/base/input_error.hpp"

#include "symbolic/derivative.hpp"
#include "symbolic/subgraph.hpp"

#include <algorithm>
#include <unordered_map>

namespace graze {

namespace {

/// @throws InputError unless `symbol` is a symbol of this graph, if there is one
void require_variable(const Expression& symbol, const std::shared_ptr<Graph>& graph) {
    if (symbol.empty() || !symbol.is_symbol())
        throw InputError("derivatives are taken with respect to symbols only", "");
    if (graph && graph != symbol.graph())
        throw InputError("the symbol belongs to another graph than the expressions", "");
}

/// Computes derivatives of the nodes of a subgraph from those of its symbols. An empty expression stands for zero.
class Derivatives {
public:
    explicit Derivatives(const Subgraph& part) : part_(part), rates_(part.items.size()) {}

    /// @param rate_of returns the derivative of the symbol at a position of the subgraph; empty if zero
    template <class RateOf>
    void find(const RateOf& rate_of) {
        for (std::size_t position = 0; position < rates_.size(); ++position) {
            const Subgraph::Item& item = part_.items[position];
            const int operands = arity(part_.node(item).operation);
            if (operands == 0)
                rates_[position] = rate_of(position);
            else if (rates_[item.left].empty() && (operands == 1 || rates_[item.right].empty()))
                rates_[position] = {};
            else
                rates_[position] = of_operation(item, operands);
        }
    }
    /// Returns the derivative of an expression.
    const Expression& of_root(std::size_t root) const { return rates_[part_.roots[root]]; }

private:
    Expression of_operation(const Subgraph::Item& item, int operands) const {
        const Subgraph::Item& left = part_.items[item.left];
        const Subgraph::Item& right = part_.items[operands == 2 ? item.right : item.left];
        Expression result = derivative_of(part_.node(item).operation, part_.expression(item), part_.expression(left),
                                          part_.expression(right), rates_[item.left],
                                          operands == 2 ? rates_[item.right] : Expression());
        return result.is_number(0) ? Expression() : result;
    }

    const Subgraph& part_;
    std::vector<Expression> rates_;
};

} // namespace

std::vector<Expression> differentiate_along(std::span<const Expression> expressions,
                                            std::span<const Component> vector) {
    const Subgraph part = subgraph_of(expressions);
    std::unordered_map<NodeIndex, Expression> components;
    for (const auto& [symbol, component] : vector) {
        require_variable(symbol, part.graph);
        if (component.empty() || component.graph() != symbol.graph())
            throw InputError("a component belongs to another graph than its symbol", "");
        if (!components.emplace(symbol.index(), component).second)
            throw InputError("symbol '" + symbol.name() + "' has two components", "");
    }
    Derivatives derivatives(part);
    derivatives.find([&](std::size_t position) {
        const auto found = components.find(part.items[position].index);
        return found == components.end() || found->second.is_number(0) ? Expression() : found->second;
    });
    std::vector<Expression> results;
    results.reserve(part.roots.size());
    for (std::size_t root = 0; root < part.roots.size(); ++root) {
        const Expression& result = derivatives.of_root(root);
        results.push_back(result.empty() ? part.graph->number(0) : result);
    }
    return results;
}

std::vector<Expression> differentiate(std::span<const Expression> expressions, const Expression& symbol) {
    require_variable(symbol, nullptr);
    const Component along(symbol, symbol.graph()->number(1));
    return differentiate_along(expressions, {&along, 1});
}

std::vector<JacobianEntry> sparse_jacobian(std::span<const Expression> expressions, const SymbolIndex& symbols) {
    std::vector<JacobianEntry> entries;
    for (std::size_t row = 0; row < expressions.size(); ++row) {
        const Subgraph part = subgraph_of(expressions.subspan(row, 1));
        if (!symbols.are_of(part.graph))
            throw InputError("a symbol belongs to another graph than the expressions", "");
        std::vector<std::pair<std::size_t, std::size_t>> occurring; // column, position
        for (std::size_t position = 0; position < part.items.size(); ++position)
            if (part.node(part.items[position]).operation == Operation::symbol)
                if (const auto column = symbols.find(part.items[position].index))
                    occurring.emplace_back(*column, position);
        std::ranges::sort(occurring);
        const Expression one = part.graph->number(1);
        Derivatives derivatives(part);
        for (const auto& occurrence : occurring) {
            derivatives.find([&](std::size_t position) { return position == occurrence.second ? one : Expression(); });
            if (const Expression& value = derivatives.of_root(0); !value.empty())
                entries.push_back({row, occurrence.first, value});
        }
    }
    return entries;
}

std::vector<Expression> jacobian(std::span<const Expression> expressions, std::span<const Expression> symbols) {
    for (const Expression& symbol : symbols)
        require_variable(symbol, expressions.empty() ? nullptr : expressions.front().graph());
    if (expressions.empty() || symbols.empty())
        return {};
    std::vector<JacobianEntry> entries = sparse_jacobian(expressions, SymbolIndex(symbols));
    std::vector<Expression> rows(expressions.size() * symbols.size(), expressions.front().graph()->number(0));
    for (JacobianEntry& entry : entries)
        rows[entry.row * symbols.size() + entry.column] = std::move(entry.value);
    return rows;
}

Expression differentiate(const Expression& expression, const Expression& symbol) {
    return differentiate(std::span(&expression, 1), symbol).front();
}

std::vector<Expression> substitute(std::span<const Expression> expressions, std::span<const Replacement> replacements) {
    const Subgraph part = subgraph_of(expressions);
    std::unordered_map<NodeIndex, NodeIndex> replaced;
    for (const auto& [symbol, replacement] : replacements) {
        if (symbol.empty() || replacement.empty() || !symbol.is_symbol())
            throw InputError("only symbols can be replaced, and only by expressions", "");
        if (part.graph && (part.graph != symbol.graph() || part.graph != replacement.graph()))
            throw InputError("a replacement belongs to another graph than the expressions", "");
        if (!replaced.emplace(symbol.index(), replacement.index()).second)
            throw InputError("symbol '" + symbol.name() + "' is to be replaced twice", "");
    }
    std::vector<NodeIndex> results(part.items.size());
    for (std::size_t position = 0; position < results.size(); ++position) {
        const Subgraph::Item& item = part.items[position];
        const Node node = part.node(item);
        const int operands = arity(node.operation);
        if (operands == 0) {
            const auto found = replaced.find(item.index);
            results[position] = found == replaced.end() ? item.index : found->second;
            continue;
        }
        const NodeIndex left = results[item.left];
        const NodeIndex right = operands == 2 ? results[item.right] : node.right;
        if (left == node.left && right == node.right)
            results[position] = item.index;
        else if (operands == 1)
            results[position] = part.graph->apply_as(*part.graph, node, Expression(part.graph, left)).index();
        else
            results[position] =
                part.graph->apply(node.operation, Expression(part.graph, left), Expression(part.graph, right)).index();
    }
    std::vector<Expression> replaced_expressions;
    replaced_expressions.reserve(part.roots.size());
    for (const std::uint32_t root : part.roots)
        replaced_expressions.emplace_back(part.graph, results[root]);
    return replaced_expressions;
}

Expression substitute(const Expression& expression, std::span<const Replacement> replacements) {
    return substitute(std::span(&expression, 1), replacements).front();
}

std::vector<Expression> symbols_of(std::span<const Expression> expressions) {
    const Subgraph part = subgraph_of(expressions);
    std::vector<Expression> symbols;
    for (const Subgraph::Item& item : part.items)
        if (part.node(item).operation == Operation::symbol)
            symbols.push_back(part.expression(item));
    std::ranges::sort(symbols, {}, &Expression::index);
    return symbols;
}

} // namespace graze
