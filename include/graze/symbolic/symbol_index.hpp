#pragma once

#include "graze/symbolic/expression.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace graze {

/// A list of symbols with constant-time lookup of their positions. Made once and shared by many functions of the same
/// inputs, so that the work for each function depends on its own size only.
class SymbolIndex {
public:
    SymbolIndex() = default;
    /// @throws InputError when an expression is empty or not a symbol, or a symbol occurs twice
    explicit SymbolIndex(std::span<const Expression> symbols);

    std::size_t size() const { return symbols_.size(); }
    const std::vector<Expression>& symbols() const { return symbols_; }
    /// Returns the position of a symbol, given that it belongs to the same graph as the list.
    std::optional<std::size_t> find(NodeIndex symbol) const;
    /// True when all symbols belong to this graph.
    bool are_of(const std::shared_ptr<Graph>& graph) const;

private:
    std::vector<Expression> symbols_;
    std::unordered_map<NodeIndex, std::size_t> places_;
    bool one_graph_ = true;
};

} // namespace graze
