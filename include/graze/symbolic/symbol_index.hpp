#pragma once

#include "graze/symbolic/expression.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace graze {

/// Symbols in an order, in which the place of each is found at once, however many they are. Made once for many
/// functions of the same inputs, so that the work for each goes by its own size.
class SymbolIndex {
public:
    SymbolIndex() = default;
    /// @throws InputError when one is empty or no symbol, or named twice
    explicit SymbolIndex(std::span<const Expression> symbols);

    std::size_t size() const { return symbols_.size(); }
    const std::vector<Expression>& symbols() const { return symbols_; }
    /// Place of a symbol of the graph to which all of them belong.
    std::optional<std::size_t> find(NodeIndex symbol) const;
    /// Whether all of them belong to this graph.
    bool are_of(const std::shared_ptr<Graph>& graph) const;

private:
    std::vector<Expression> symbols_;
    std::unordered_map<NodeIndex, std::size_t> places_;
    bool one_graph_ = true;
};

} // namespace graze
