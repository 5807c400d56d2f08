#pragma once

#include "graze/symbolic/expression.hpp"

namespace graze {

/// Builds nodes in their canonical form: one node for all ways to write an expression that differ by
/// no more than round-off (docs/expressions.md lists the rules). Applying the operation of a canonical node to
/// its operands gives that node again, which is what lets printed text parse back to the same node.
///
/// Signs are handled in one place: every expression is a sign and a magnitude, operations combine magnitudes,
/// and the sign is put back on the result. No rule recurses on the operands.
class Simplifier {
public:
    explicit Simplifier(Graph& graph) : graph_(graph) {}

    NodeIndex function(Operation operation, NodeIndex operand);
    NodeIndex arithmetic(Operation operation, NodeIndex left, NodeIndex right);

private:
    struct Signed {
        bool negative;
        NodeIndex magnitude;
    };

    const Node& node(NodeIndex index) const { return graph_.nodes_[index]; }
    bool is_number(NodeIndex index) const { return node(index).operation == Operation::number; }
    bool is_number(NodeIndex index, double value) const { return is_number(index) && node(index).value == value; }
    bool has_number_on_left(NodeIndex index, Operation operation) const {
        return node(index).operation == operation && is_number(node(index).left);
    }
    bool has_number_on_right(NodeIndex index, Operation operation) const {
        return node(index).operation == operation && is_number(node(index).right);
    }

    NodeIndex number(double value);
    NodeIndex intern(Operation operation, NodeIndex left, NodeIndex right = 0);
    Signed split(NodeIndex index);
    NodeIndex negated(NodeIndex magnitude);
    NodeIndex with_sign(Signed value) { return value.negative ? negated(value.magnitude) : value.magnitude; }

    NodeIndex sum(Signed left, Signed right);
    NodeIndex sum_with_constant(NodeIndex magnitude, double constant);
    NodeIndex product(NodeIndex left, NodeIndex right);
    NodeIndex scaled(double factor, NodeIndex magnitude);
    NodeIndex quotient(NodeIndex left, NodeIndex right);
    NodeIndex power(NodeIndex base, NodeIndex exponent);

    Graph& graph_;
};

} // namespace graze
