#include "graze/symbolic/transform.hpp"

#include "symbolic/function_table.hpp"
#include "symbolic/subgraph.hpp"

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

namespace graze {

namespace {

/// Sum in which an empty expression stands for an absent (zero) term.
Expression sum(const Expression& a, const Expression& b) {
    if (a.empty())
        return b;
    return b.empty() ? a : a + b;
}

/// Derivative of base^exponent. A constant exponent brings no logarithm, so that powers of negative bases have
/// derivatives too.
Expression derivative_of_power(const Expression& value, const Expression& base, const Expression& exponent,
                               const Expression& base_rate, const Expression& exponent_rate) {
    Expression result;
    if (!base_rate.empty())
        result = exponent * pow(base, exponent - 1) * base_rate;
    if (!exponent_rate.empty())
        result = sum(result, value * log(base) * exponent_rate);
    return result;
}

Expression square(const Expression& x) {
    return pow(x, 2);
}
Expression one_minus_square(const Expression& x) {
    return 1 - square(x);
}

/// d/da of an operation of one operand a, in terms of it and of the value y.
Expression slope_of(Operation operation, const Expression& y, const Expression& a) {
    switch (operation) {
    case Operation::negate:
        return a.graph()->number(-1);
#define GRAZE_ROW(name, recurrence, slope)                                                                             \
    case Operation::name:                                                                                              \
        return slope;
        GRAZE_FUNCTIONS(GRAZE_ROW)
#undef GRAZE_ROW
    default:
        throw std::invalid_argument("an operation of one operand was expected");
    }
}

/// Derivative of a node from those of its operands, which are empty where they are zero (but not all).
Expression derivative(Operation operation, const Expression& value, const Expression& left, const Expression& right,
                      const Expression& left_rate, const Expression& right_rate) {
    switch (operation) {
    case Operation::add:
        return sum(left_rate, right_rate);
    case Operation::subtract:
        return sum(left_rate, right_rate.empty() ? right_rate : -right_rate);
    case Operation::multiply:
        return sum(left_rate.empty() ? left_rate : left_rate * right,
                   right_rate.empty() ? right_rate : left * right_rate);
    case Operation::divide:
        return sum(left_rate, right_rate.empty() ? right_rate : -(value * right_rate)) / right;
    case Operation::power:
        return derivative_of_power(value, left, right, left_rate, right_rate);
    default:
        break;
    }
    return slope_of(operation, value, left) * left_rate;
}

/// @throws std::invalid_argument unless it is a symbol of the graph of some expressions, if there are any
void require_variable(const Expression& symbol, const std::shared_ptr<Graph>& graph) {
    if (symbol.empty() || !symbol.is_symbol())
        throw std::invalid_argument("derivatives are taken with respect to symbols only");
    if (graph && graph != symbol.graph())
        throw std::invalid_argument("the symbol belongs to another graph than the expressions");
}

} // namespace

std::vector<Expression> differentiate_along(std::span<const Expression> expressions,
                                            std::span<const Component> vector) {
    const Subgraph part = subgraph_of(expressions);
    std::unordered_map<NodeIndex, Expression> components;
    for (const auto& [symbol, component] : vector) {
        require_variable(symbol, part.graph);
        if (component.empty() || component.graph() != symbol.graph())
            throw std::invalid_argument("a component belongs to another graph than its symbol");
        if (!components.emplace(symbol.index(), component).second)
            throw std::invalid_argument("symbol '" + symbol.name() + "' has two components");
    }
    std::vector<Expression> rates(part.items.size()); // empty where zero
    for (std::size_t position = 0; position < rates.size(); ++position) {
        const Subgraph::Item& item = part.items[position];
        const Operation operation = part.node(item).operation;
        const int operands = arity(operation);
        if (operands == 0) {
            const auto found = components.find(item.index);
            if (found != components.end() && !found->second.is_number(0))
                rates[position] = found->second;
            continue;
        }
        if (rates[item.left].empty() && (operands == 1 || rates[item.right].empty()))
            continue;
        const Subgraph::Item& left = part.items[item.left];
        const Subgraph::Item& right = part.items[operands == 2 ? item.right : item.left];
        const Expression result =
            derivative(operation, part.expression(item), part.expression(left), part.expression(right),
                       rates[item.left], operands == 2 ? rates[item.right] : Expression());
        if (!result.is_number(0))
            rates[position] = result;
    }
    std::vector<Expression> results;
    results.reserve(part.roots.size());
    for (const std::uint32_t root : part.roots)
        results.push_back(rates[root].empty() ? part.graph->number(0) : rates[root]);
    return results;
}

std::vector<Expression> differentiate(std::span<const Expression> expressions, const Expression& symbol) {
    require_variable(symbol, nullptr);
    const Component along(symbol, symbol.graph()->number(1));
    return differentiate_along(expressions, {&along, 1});
}

std::vector<Expression> jacobian(std::span<const Expression> expressions, std::span<const Expression> symbols) {
    const std::vector<Expression> occurring = symbols_of(expressions); // of many symbols, mostly few
    const std::size_t columns = symbols.size();
    std::vector<Expression> rows(expressions.size() * columns);
    if (rows.empty())
        return rows;
    for (std::size_t column = 0; column < columns; ++column) {
        require_variable(symbols[column], expressions.front().graph());
        const bool occurs = std::find(occurring.begin(), occurring.end(), symbols[column]) != occurring.end();
        const std::vector<Expression> derivatives =
            occurs ? differentiate(expressions, symbols[column])
                   : std::vector<Expression>(expressions.size(), expressions.front().graph()->number(0));
        for (std::size_t row = 0; row < expressions.size(); ++row)
            rows[row * columns + column] = derivatives[row];
    }
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
            throw std::invalid_argument("only symbols can be replaced, and only by expressions");
        if (part.graph && (part.graph != symbol.graph() || part.graph != replacement.graph()))
            throw std::invalid_argument("a replacement belongs to another graph than the expressions");
        if (!replaced.emplace(symbol.index(), replacement.index()).second)
            throw std::invalid_argument("symbol '" + symbol.name() + "' is to be replaced twice");
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
            results[position] = part.graph->apply(node.operation, Expression(part.graph, left)).index();
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
