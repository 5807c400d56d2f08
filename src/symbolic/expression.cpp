#include "graze/symbolic/expression.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/piece_table.hpp"

#include "symbolic/function_table.hpp"
#include "symbolic/simplify.hpp"
#include "symbolic/subgraph.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace graze {

namespace {

Expression apply(Operation operation, const Expression& operand) {
    if (operand.empty())
        throw InputError("an operand is an empty expression", "");
    return operand.graph()->apply(operation, operand);
}

Expression apply(Operation operation, const Expression& left, const Expression& right) {
    if (left.empty())
        throw InputError("an operand is an empty expression", "");
    return left.graph()->apply(operation, left, right);
}

constexpr bool is_complete() {
    for (int i = 0; i < function_count; ++i)
        if (static_cast<int>(all_functions[i]) != static_cast<int>(Operation::negate) + 1 + i)
            return false;
    return true;
}
static_assert(is_complete(), "the table of functions has another order than Operation");

Expression number_beside(const Expression& expression, double value) {
    if (expression.empty())
        throw InputError("an operand is an empty expression", "");
    return expression.graph()->number(value);
}

} // namespace

int arity(Operation operation) {
    switch (operation) {
    case Operation::number:
    case Operation::symbol:
        return 0;
    case Operation::add:
    case Operation::subtract:
    case Operation::multiply:
    case Operation::divide:
    case Operation::power:
        return 2;
    default:
        break;
    }
    if (operation > Operation::lookup)
        throw InputError("there is no such operation", "");
    return 1;
}

void Expression::refuse_node() {
    throw InputError("the graph does not have such a node", "");
}

void Expression::refuse_empty() {
    throw InputError("an expression is empty: it names nothing", "");
}

void Expression::refuse_name() {
    throw InputError("only symbols have names", "");
}

std::size_t Graph::Hash::operator()(const Node& node) const {
    // Operands are small consecutive integers: multiply-and-fold spreads them over all bits.
    constexpr std::uint64_t odd = 0x9e3779b97f4a7c15;
    std::uint64_t mixed = std::bit_cast<std::uint64_t>(node.value) ^ static_cast<std::uint64_t>(node.operation);
    for (const std::uint64_t part : {std::uint64_t{node.left}, std::uint64_t{node.right}}) {
        mixed = (mixed ^ (mixed >> 32)) * odd;
        mixed += part;
    }
    mixed = (mixed ^ (mixed >> 29)) * odd;
    return static_cast<std::size_t>(mixed ^ (mixed >> 32));
}

bool Graph::Equal::operator()(const Node& one, const Node& other) const {
    return one.operation == other.operation && one.left == other.left && one.right == other.right &&
           one.value == other.value;
}

std::shared_ptr<Graph> Graph::create() {
    return std::shared_ptr<Graph>(new Graph);
}

std::shared_ptr<Graph> Graph::copy() const {
    std::shared_ptr<Graph> result(new Graph(*this));
    result->frozen_ = false;
    return result;
}

void Graph::require_growing() const {
    if (frozen_)
        throw OrderError("the graph of a compiled system cannot grow: make new expressions in a copy of its model");
}

Expression Graph::adopt(const Expression& foreign) {
    if (foreign.graph().get() == this)
        return foreign;
    const Subgraph part = subgraph_of(std::span(&foreign, 1));
    std::vector<NodeIndex> own;
    for (const Subgraph::Item& item : part.items) {
        Node node = part.node(item);
        if (node.operation == Operation::symbol)
            node.left = symbol(part.graph->symbol_name(node)).index();
        else if (arity(node.operation) > 0)
            node.left = own[item.left];
        if (node.operation == Operation::lookup)
            node.right = own_lookup(*part.graph, node);
        if (arity(node.operation) == 2)
            node.right = own[item.right];
        own.push_back(node.operation == Operation::symbol ? node.left : intern(node));
    }
    return {shared_from_this(), own[part.roots.front()]};
}

NodeIndex Graph::intern(Node node) {
    const auto found = indices_.find(node);
    if (found != indices_.end())
        return found->second;
    require_growing();
    if (nodes_.size() >= std::numeric_limits<NodeIndex>::max())
        throw InputError("an expression graph is full", "");
    // Constants have been folded wherever the result is finite, so constant operands mean that there is none.
    bool undefined = false;
    const auto is_number = [&](NodeIndex operand) { return nodes_[operand].operation == Operation::number; };
    if (arity(node.operation) == 1)
        undefined = undefined_[node.left] || is_number(node.left);
    else if (arity(node.operation) == 2)
        undefined = undefined_[node.left] || undefined_[node.right] ||
                    (is_number(node.left) && is_number(node.right)) ||
                    (node.operation == Operation::divide && is_number(node.right) && nodes_[node.right].value == 0);
    const auto index = static_cast<NodeIndex>(nodes_.size());
    nodes_.push_back(node);
    undefined_.push_back(undefined);
    indices_.emplace(node, index);
    return index;
}

NodeIndex Graph::own(const Expression& expression) const {
    if (expression.graph().get() != this)
        throw InputError(expression.empty() ? "an operand is an empty expression"
                                            : "expressions of different graphs cannot be combined",
                         "");
    return expression.index();
}

Expression Graph::number(double value) {
    if (!std::isfinite(value))
        throw InputError("a number in an expression must be finite", "");
    // Adding 0 turns -0 into 0.
    return {shared_from_this(), intern({Operation::number, 0, 0, value + 0.0})};
}

Expression Graph::symbol(std::string_view name) {
    auto entry = name_indices_.find(std::string(name));
    if (entry == name_indices_.end()) {
        require_growing();
        entry = name_indices_.emplace(std::string(name), static_cast<NodeIndex>(names_.size())).first;
        names_.emplace_back(name);
    }
    return {shared_from_this(), intern({Operation::symbol, entry->second, 0, 0})};
}

Expression Graph::apply(Operation operation, const Expression& operand) {
    if (arity(operation) != 1)
        throw InputError("an operation that does not take one operand was given one", "");
    return {shared_from_this(), Simplifier(*this).function(operation, own(operand))};
}

Expression Graph::apply(Operation operation, const Expression& left, const Expression& right) {
    if (arity(operation) != 2)
        throw InputError("an operation that does not take two operands was given two", "");
    return {shared_from_this(), Simplifier(*this).arithmetic(operation, own(left), own(right))};
}

Expression Graph::apply_as(const Graph& from, const Node& node, const Expression& operand) {
    if (node.operation != Operation::lookup)
        return apply(node.operation, operand);
    const auto [table, derivative] = lookup_of(node);
    return look_up(&from == this ? table : add_table(from.tables_[table]), derivative, operand);
}

std::size_t Graph::add_table(std::shared_ptr<const PieceTable> table) {
    for (std::size_t i = 0; i < tables_.size(); ++i)
        if (tables_[i]->name() == table->name()) {
            if (tables_[i] != table && !(*tables_[i] == *table))
                throw InputError("there are two tables '" + table->name() + "'", "rename one of them");
            return i;
        }
    require_growing();
    tables_.push_back(std::move(table));
    return tables_.size() - 1;
}

NodeIndex Graph::own_lookup(const Graph& from, const Node& node) {
    const auto [table, derivative] = lookup_of(node);
    return static_cast<NodeIndex>(4 * add_table(from.tables_[table]) + static_cast<std::size_t>(derivative));
}

Expression Graph::look_up(std::size_t table, int derivative, const Expression& operand) {
    require_index(table, tables_.size(), "table");
    const NodeIndex index = own(operand);
    if (derivative > tables_[table]->degree())
        return number(0);
    if (nodes_[index].operation == Operation::number)
        if (const double value = tables_[table]->value(nodes_[index].value, derivative); std::isfinite(value))
            return number(value);
    const auto code = static_cast<NodeIndex>(4 * table + static_cast<std::size_t>(derivative));
    return {shared_from_this(), intern({Operation::lookup, index, code, 0})};
}

Expression operator+(const Expression& a, const Expression& b) {
    return apply(Operation::add, a, b);
}
Expression operator-(const Expression& a, const Expression& b) {
    return apply(Operation::subtract, a, b);
}
Expression operator*(const Expression& a, const Expression& b) {
    return apply(Operation::multiply, a, b);
}
Expression operator/(const Expression& a, const Expression& b) {
    return apply(Operation::divide, a, b);
}
Expression operator+(const Expression& a, double b) {
    return a + number_beside(a, b);
}
Expression operator-(const Expression& a, double b) {
    return a - number_beside(a, b);
}
Expression operator*(const Expression& a, double b) {
    return a * number_beside(a, b);
}
Expression operator/(const Expression& a, double b) {
    return a / number_beside(a, b);
}
Expression operator+(double a, const Expression& b) {
    return number_beside(b, a) + b;
}
Expression operator-(double a, const Expression& b) {
    return number_beside(b, a) - b;
}
Expression operator*(double a, const Expression& b) {
    return number_beside(b, a) * b;
}
Expression operator/(double a, const Expression& b) {
    return number_beside(b, a) / b;
}
Expression operator-(const Expression& a) {
    return apply(Operation::negate, a);
}
Expression pow(const Expression& a, const Expression& b) {
    return apply(Operation::power, a, b);
}
Expression pow(const Expression& a, double b) {
    return pow(a, number_beside(a, b));
}
#define GRAZE_ROW(name, recurrence, slope)                                                                             \
    Expression name(const Expression& a) {                                                                             \
        return apply(Operation::name, a);                                                                              \
    }
GRAZE_FUNCTIONS(GRAZE_ROW)
#undef GRAZE_ROW

} // namespace graze
