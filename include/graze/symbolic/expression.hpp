#pragma once

#include "graze/base/require.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace graze {

class Expression;
class PieceTable;

/// The elementary operations of which every expression is made. `number` and `symbol` are leaves.
enum class Operation : std::uint8_t {
    number,
    symbol,
    add,
    subtract,
    multiply,
    divide,
    power,
    negate,
    sqrt,
    exp,
    log,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    erf,
    lookup, ///< a table, or one of its derivatives, at its operand
};

/// Returns the number of operands: 0 for leaves, 1 for functions and negation, 2 for arithmetic.
/// @throws InputError for a value that is not an Operation
int arity(Operation operation);

/// Index of a node in its graph. Operands always have smaller indices than the node that uses them, so that a
/// loop over rising indices visits operands first: no algorithm on graphs recurses.
using NodeIndex = std::uint32_t;

struct Node {
    Operation operation = Operation::number;
    NodeIndex left = 0;  ///< first operand; for a symbol, the index of its name
    NodeIndex right = 0; ///< second operand of arithmetic operations; of a lookup, which table and derivative
    double value = 0;    ///< of a number
};

/// Owner of expressions: an append-only, hash-consed graph in which equal subexpressions exist once.
/// Reading and copying from several threads at once is safe, appending is not.
class Graph : public std::enable_shared_from_this<Graph> {
public:
    static std::shared_ptr<Graph> create();
    /// Returns another graph with the same nodes at the same indices, which is not frozen.
    std::shared_ptr<Graph> copy() const;
    /// Forbids appending, so that threads may share the graph: an attempt to append then throws OrderError.
    void freeze() { frozen_ = true; }
    bool is_frozen() const { return frozen_; }
    /// Returns the same expression in this graph; symbols are matched by name.
    /// @throws InputError for an empty expression
    Expression adopt(const Expression& foreign);

    /// @throws InputError when the value is not finite. +0 and -0 are one node.
    Expression number(double value);
    /// Returns the symbol of this name; the same node for each call.
    Expression symbol(std::string_view name);
    /// Applies one operation, with the simplifications described in docs/expressions.md: results are equal to
    /// those of the unsimplified expression up to round-off.
    /// @throws InputError for operands of another graph, or a wrong number of operands
    Expression apply(Operation operation, const Expression& operand);
    Expression apply(Operation operation, const Expression& left, const Expression& right);

    /// Applies the operation with one operand of a node of another graph, or of this one.
    Expression apply_as(const Graph& from, const Node& node, const Expression& operand);

    using Tables = std::vector<std::shared_ptr<const PieceTable>>;
    /// Tables that expressions may look up, by name.
    const Tables& tables() const { return tables_; }
    /// Adds a table, unless an equal one is there. @return its index
    /// @throws InputError if another table has its name
    std::size_t add_table(std::shared_ptr<const PieceTable> table);
    /// Returns the value of a table, or of its derivative, at an operand.
    Expression look_up(std::size_t table, int derivative, const Expression& operand);
    /// The table that a lookup uses, and the derivative.
    struct Lookup {
        std::size_t table;
        int derivative;
    };
    static Lookup lookup_of(const Node& node) { return {node.right / 4, static_cast<int>(node.right % 4)}; }

    std::size_t size() const { return nodes_.size(); }
    /// @throws InputError, here and below, when the graph has no such index
    const Node& node(NodeIndex index) const {
        require_index(index, nodes_.size(), "node");
        return nodes_[index];
    }
    const std::string& symbol_name(const Node& node) const {
        require_index(node.left, names_.size(), "name");
        return names_[node.left];
    }
    /// True when the node has no finite value for any values of its symbols, as 1/0, log(-1) + x or 1e308*10. Such
    /// expressions are kept unsimplified.
    bool is_undefined(NodeIndex index) const {
        require_index(index, undefined_.size(), "node");
        return undefined_[index];
    }

private:
    friend class Simplifier;
    Graph() = default;
    Graph(const Graph& other) = default;
    void require_growing() const;
    NodeIndex intern(Node node);
    NodeIndex own(const Expression& expression) const;
    NodeIndex own_lookup(const Graph& from, const Node& node);

    struct Hash {
        std::size_t operator()(const Node& node) const;
    };
    struct Equal {
        bool operator()(const Node& one, const Node& other) const;
    };
    std::vector<Node> nodes_;
    std::vector<bool> undefined_;
    std::vector<std::string> names_;
    Tables tables_;
    std::unordered_map<std::string, NodeIndex> name_indices_;
    std::unordered_map<Node, NodeIndex, Hash, Equal> indices_;
    bool frozen_ = false;
};

/// A node of a graph that it keeps alive; cheap to copy. Two expressions of one graph are the same expression
/// exactly if their indices are equal. Operators throw InputError for operands of different graphs.
class Expression {
public:
    /// An empty expression: only assignment and `empty` may be used.
    Expression() = default;
    /// @throws InputError for an index that the graph does not have
    Expression(std::shared_ptr<Graph> graph, NodeIndex index) : graph_(std::move(graph)), index_(index) {
        if (!graph_ || index >= graph_->size())
            refuse_node();
    }

    bool empty() const { return graph_ == nullptr; }
    const std::shared_ptr<Graph>& graph() const { return graph_; }
    NodeIndex index() const { return index_; }
    /// @throws InputError, here and below, when the expression is empty
    const Node& node() const {
        if (!graph_)
            refuse_empty();
        return graph_->node(index_);
    }
    Operation operation() const { return node().operation; }
    bool is_number() const { return operation() == Operation::number; }
    bool is_number(double value) const { return is_number() && node().value == value; }
    bool is_symbol() const { return operation() == Operation::symbol; }
    /// Returns the name of a symbol. @throws InputError for any other expression
    const std::string& name() const {
        if (!is_symbol())
            refuse_name();
        return graph_->symbol_name(node());
    }

    friend bool operator==(const Expression& one, const Expression& other) {
        return one.graph_ == other.graph_ && one.index_ == other.index_;
    }

private:
    [[noreturn]] static void refuse_node();
    [[noreturn]] static void refuse_empty();
    [[noreturn]] static void refuse_name();
    std::shared_ptr<Graph> graph_;
    NodeIndex index_ = 0;
};

Expression operator+(const Expression& a, const Expression& b);
Expression operator-(const Expression& a, const Expression& b);
Expression operator*(const Expression& a, const Expression& b);
Expression operator/(const Expression& a, const Expression& b);
Expression operator+(const Expression& a, double b);
Expression operator-(const Expression& a, double b);
Expression operator*(const Expression& a, double b);
Expression operator/(const Expression& a, double b);
Expression operator+(double a, const Expression& b);
Expression operator-(double a, const Expression& b);
Expression operator*(double a, const Expression& b);
Expression operator/(double a, const Expression& b);
Expression operator-(const Expression& a);
Expression pow(const Expression& a, const Expression& b);
Expression pow(const Expression& a, double b);
Expression sqrt(const Expression& a);
Expression exp(const Expression& a);
Expression log(const Expression& a);
Expression sin(const Expression& a);
Expression cos(const Expression& a);
Expression tan(const Expression& a);
Expression asin(const Expression& a);
Expression acos(const Expression& a);
Expression atan(const Expression& a);
Expression sinh(const Expression& a);
Expression cosh(const Expression& a);
Expression tanh(const Expression& a);
Expression erf(const Expression& a);

} // namespace graze
