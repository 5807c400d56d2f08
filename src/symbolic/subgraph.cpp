#include "symbolic/subgraph.hpp"

#include <stdexcept>
#include <unordered_map>

namespace graze {

Subgraph subgraph_of(std::span<const Expression> expressions) {
    Subgraph result;
    for (const Expression& expression : expressions) {
        if (expression.empty())
            throw std::invalid_argument("an expression is empty");
        if (result.graph && result.graph != expression.graph())
            throw std::invalid_argument("the expressions belong to different graphs");
        result.graph = expression.graph();
    }
    std::unordered_map<NodeIndex, std::uint32_t> positions;
    std::vector<NodeIndex> pending;
    for (const Expression& expression : expressions) {
        pending.push_back(expression.index());
        while (!pending.empty()) {
            const NodeIndex index = pending.back();
            if (positions.contains(index)) {
                pending.pop_back();
                continue;
            }
            const Node& node = result.graph->node(index);
            const int operands = arity(node.operation);
            const std::size_t pending_before = pending.size();
            // The left operand is pushed last so that it comes first.
            if (operands == 2 && !positions.contains(node.right))
                pending.push_back(node.right);
            if (operands >= 1 && !positions.contains(node.left))
                pending.push_back(node.left);
            if (pending.size() > pending_before)
                continue;
            pending.pop_back();
            positions.emplace(index, static_cast<std::uint32_t>(result.items.size()));
            result.items.push_back(
                {index, operands >= 1 ? positions.at(node.left) : 0, operands == 2 ? positions.at(node.right) : 0});
        }
        result.roots.push_back(positions.at(expression.index()));
    }
    return result;
}

} // namespace graze
