#pragma once

#include "graze/symbolic/expression.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// All nodes on which the given expressions depend, operands before the nodes that use them. Positions in this list
/// replace indices in the graph, so that work on a small expression of a large graph stays small.
struct Subgraph {
    struct Item {
        NodeIndex index;         ///< in the graph
        std::uint32_t left = 0;  ///< position of the first operand, if any
        std::uint32_t right = 0; ///< position of the second operand, if any
    };
    std::shared_ptr<Graph> graph; ///< empty when there are no expressions
    std::vector<Item> items;
    std::vector<std::uint32_t> roots; ///< positions of the expressions

    const Node& node(const Item& item) const { return graph->node(item.index); }
    Expression expression(const Item& item) const { return {graph, item.index}; }
};

/// @throws InputError for empty expressions or expressions of different graphs
Subgraph subgraph_of(std::span<const Expression> expressions);

} // namespace graze
