#pragma once

#include "graze/symbolic/linearisation.hpp"
#include "symbolic/subgraph.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <queue>
#include <span>
#include <vector>

namespace graze {

/// Returns for each node of a subgraph whether it depends on one of the first `first` variables.
std::vector<bool> nodes_with(const Subgraph& part, const SymbolIndex& variables, std::size_t first);

/// Differentiates functions (the roots of a subgraph) and intermediates (nodes of it) with respect to sources: the
/// variables, and the intermediates that come before. Entries are in the order of Linearisation.
class LinearRows {
public:
    /// @param intermediates positions in the subgraph, rising
    LinearRows(const Subgraph& part, const SymbolIndex& variables, std::span<const std::uint32_t> intermediates);

    /// Reverse mode, from each function to its sources: time proportional to the size of a row, for any number of
    /// sources.
    std::vector<LinearEntry> from_functions();
    /// Forward mode, from each source to the function, as in transform.hpp: rows share common parts.
    std::vector<LinearEntry> from_sources();
    /// Returns the number of nodes that from_sources visits.
    std::size_t work_from_sources();

private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    using Position = std::uint32_t;

    bool is_source(Position position, Position row) const { return sources_[position] != none && position != row; }
    /// The node whose derivatives form a row; `own` is the same node for an intermediate, past the end for a function.
    struct Row {
        Position position, own;
    };
    std::size_t rows() const { return intermediates_.size() + part_.roots.size(); }
    Row row(std::size_t index) const;
    void sort_from(std::size_t first, std::vector<LinearEntry>& entries) const;

    void add(Position position, const Expression& weight);
    void pass_on(Position position, const Expression& weight);

    /// The divisor of a quotient, if it is a power of another node.
    struct Divisor {
        Position base;
        Expression exponent; ///< a number above zero
    };
    std::optional<Divisor> power_below(const Subgraph::Item& item) const;

    /// Returns the nodes between a row and its sources, both included, operands first.
    std::vector<Position> nodes_of(const Row& row);
    Expression rate_of(Position position) const;

    const Subgraph& part_;
    std::vector<Position> intermediates_;
    std::vector<bool> reaches_; ///< whether a node depends on any variable
    std::vector<std::size_t> sources_;
    std::vector<Expression>
        weights_; ///< derivatives of a row with respect to nodes, or of nodes with respect to a source
    std::priority_queue<Position> pending_; ///< nodes before their operands
    std::vector<bool> seen_;
};

} // namespace graze
