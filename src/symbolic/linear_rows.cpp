#include "symbolic/linear_rows.hpp"

#include "symbolic/derivative.hpp"

#include <algorithm>
#include <utility>

namespace graze {

namespace {

/// Derivatives of an operation with respect to its left and right operand, times a weight.
Expression to_left(Operation operation, const Expression& left, const Expression& right, const Expression& weight) {
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
Expression to_right(Operation operation, const Expression& value, const Expression& left, const Expression& right,
                    const Expression& weight) {
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

} // namespace

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

LinearRows::LinearRows(const Subgraph& part, const SymbolIndex& variables, std::span<const Position> intermediates)
    : part_(part), intermediates_(intermediates.begin(), intermediates.end()),
      reaches_(nodes_with(part, variables, variables.size())), sources_(part.items.size(), none),
      weights_(part.items.size()), seen_(part.items.size()) {
    for (std::size_t position = 0; position < sources_.size(); ++position)
        if (part.node(part.items[position]).operation == Operation::symbol)
            if (const auto place = variables.find(part.items[position].index))
                sources_[position] = *place;
    for (std::size_t i = 0; i < intermediates.size(); ++i)
        sources_[intermediates[i]] = variables.size() + i;
}

LinearRows::Row LinearRows::row(std::size_t index) const {
    if (index < intermediates_.size())
        return {intermediates_[index], intermediates_[index]};
    return {part_.roots[index - intermediates_.size()], static_cast<Position>(part_.items.size())};
}

void LinearRows::sort_from(std::size_t first, std::vector<LinearEntry>& entries) const {
    std::sort(entries.begin() + static_cast<std::ptrdiff_t>(first), entries.end(),
              [](const LinearEntry& one, const LinearEntry& other) { return one.source < other.source; });
}

std::vector<LinearEntry> LinearRows::from_functions() {
    std::vector<LinearEntry> entries;
    for (std::size_t index = 0; index < rows(); ++index) {
        const std::size_t first = entries.size();
        const auto [root, own] = row(index);
        add(root, part_.graph->number(1));
        while (!pending_.empty()) {
            const Position next = pending_.top();
            pending_.pop();
            const Expression weight = std::exchange(weights_[next], {});
            if (weight.is_number(0))
                continue;
            if (is_source(next, own))
                entries.push_back({index, sources_[next], weight});
            else
                pass_on(next, weight);
        }
        sort_from(first, entries);
    }
    return entries;
}

void LinearRows::add(Position position, const Expression& weight) {
    if (!reaches_[position])
        return;
    Expression& sum = weights_[position];
    if (sum.empty())
        pending_.push(position);
    sum = sum.empty() ? weight : sum + weight;
}

void LinearRows::pass_on(Position position, const Expression& weight) {
    const Subgraph::Item& item = part_.items[position];
    const Operation operation = part_.node(item).operation;
    const Expression value = part_.expression(item), left = part_.expression(part_.items[item.left]);
    if (arity(operation) == 1) {
        add(item.left, slope_of(operation, value, left) * weight);
        return;
    }
    const Expression right = part_.expression(part_.items[item.right]);
    if (const auto divisor = power_below(item)) {
        if (reaches_[item.left])
            add(item.left, weight / right);
        add(divisor->base, -(divisor->exponent * value * weight / part_.expression(part_.items[divisor->base])));
        return;
    }
    const bool to_both = reaches_[item.left] && reaches_[item.right];
    if (to_both && operation == Operation::divide) { // the quotient weight / right is formed once
        const Expression share = weight / right;
        add(item.left, share);
        add(item.right, -(value * share));
        return;
    }
    if (reaches_[item.left]) // derivatives that are not needed are not formed
        add(item.left, to_left(operation, left, right, weight));
    if (reaches_[item.right])
        add(item.right, to_right(operation, value, left, right, weight));
}

/// A quotient a / u^c has the derivative -c (a / u^c) / u by u: it reuses the value of the quotient itself.
std::optional<LinearRows::Divisor> LinearRows::power_below(const Subgraph::Item& item) const {
    if (part_.node(item).operation != Operation::divide || sources_[item.right] != none || !reaches_[item.right])
        return std::nullopt;
    const Subgraph::Item& right = part_.items[item.right];
    if (part_.node(right).operation != Operation::power)
        return std::nullopt;
    const Expression exponent = part_.expression(part_.items[right.right]);
    if (!exponent.is_number() ||
        !(exponent.node().value > 0)) // with a negative exponent the quotient may be regular at u = 0
        return std::nullopt;
    return Divisor{right.left, exponent};
}

std::vector<LinearRows::Position> LinearRows::nodes_of(const Row& row) {
    std::vector<Position> nodes, pending;
    const auto visit = [&](Position position) {
        if (!reaches_[position] || seen_[position])
            return;
        seen_[position] = true;
        nodes.push_back(position);
        if (!is_source(position, row.own))
            pending.push_back(position);
    };
    visit(row.position);
    while (!pending.empty()) {
        const Position position = pending.back();
        pending.pop_back();
        const Subgraph::Item& item = part_.items[position];
        visit(item.left);
        if (arity(part_.node(item).operation) == 2)
            visit(item.right);
    }
    for (const Position node : nodes)
        seen_[node] = false;
    std::ranges::sort(nodes);
    return nodes;
}

std::size_t LinearRows::work_from_sources() {
    std::size_t work = 0;
    for (std::size_t index = 0; index < rows(); ++index) {
        const Row one = row(index);
        const std::vector<Position> nodes = nodes_of(one);
        const auto sources = std::ranges::count_if(nodes, [&](Position node) { return is_source(node, one.own); });
        work += nodes.size() * static_cast<std::size_t>(sources);
    }
    return work;
}

std::vector<LinearEntry> LinearRows::from_sources() {
    std::vector<LinearEntry> entries;
    for (std::size_t index = 0; index < rows(); ++index) {
        const std::size_t first = entries.size();
        const Row one = row(index);
        const std::vector<Position> nodes = nodes_of(one);
        for (const Position source : nodes) {
            if (!is_source(source, one.own))
                continue;
            for (const Position node : nodes)
                if (node == source)
                    weights_[node] = part_.graph->number(1);
                else
                    weights_[node] = is_source(node, one.own) ? Expression() : rate_of(node);
            if (const Expression& value = weights_[one.position]; !value.empty())
                entries.push_back({index, sources_[source], value});
        }
        for (const Position node : nodes)
            weights_[node] = {};
        sort_from(first, entries);
    }
    return entries;
}

/// Returns the derivative of a node, given those of its operands; empty stands for zero.
Expression LinearRows::rate_of(Position position) const {
    const Subgraph::Item& item = part_.items[position];
    const Operation operation = part_.node(item).operation;
    const bool two = arity(operation) == 2;
    const Expression &left = weights_[item.left], none_at_all = {}, &right = two ? weights_[item.right] : none_at_all;
    if (left.empty() && right.empty())
        return {};
    const Expression value = part_.expression(item);
    Expression rate;
    if (const auto divisor = power_below(item)) {
        const Expression& base = weights_[divisor->base];
        if (!left.empty())
            rate = left / part_.expression(part_.items[item.right]);
        if (!base.empty()) {
            const Expression share = divisor->exponent * value * base / part_.expression(part_.items[divisor->base]);
            rate = rate.empty() ? -share : rate - share;
        }
    } else {
        rate = derivative_of(operation, value, part_.expression(part_.items[item.left]),
                             part_.expression(part_.items[two ? item.right : item.left]), left, right);
    }
    return rate.is_number(0) ? Expression() : rate;
}

} // namespace graze
