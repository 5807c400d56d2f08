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

/// Which nodes of a subgraph have one of the first variables in them.
std::vector<bool> nodes_with(const Subgraph& part, const SymbolIndex& variables, std::size_t first);

/// Derivatives of functions, the roots of a subgraph, and of intermediates, nodes of it, by sources: variables, and
/// intermediates that come before. Entries are in the order of Linearisation.
class LinearRows {
public:
    /// @param intermediates positions in the subgraph, rising
    LinearRows(const Subgraph& part, const SymbolIndex& variables, std::span<const std::uint32_t> intermediates);

    /// From each function down to its sources: a row takes the time of its size, however many sources it has.
    std::vector<LinearEntry> from_functions();
    /// From each source up to the function, as in transform.hpp: what rows have in common is shared.
    std::vector<LinearEntry> from_sources();
    /// Nodes that this visits.
    std::size_t work_from_sources();

private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    using Position = std::uint32_t;

    bool is_source(Position position, Position row) const { return sources_[position] != none && position != row; }
    /// Position of what a row is of, and where its own node is if that is an intermediate, or nothing.
    struct Row {
        Position position, own;
    };
    std::size_t rows() const { return intermediates_.size() + part_.roots.size(); }
    Row row(std::size_t index) const;
    void sort_from(std::size_t first, std::vector<LinearEntry>& entries) const;

    void add(Position position, const Expression& weight);
    void pass_on(Position position, const Expression& weight);

    /// What a quotient divides by: a power of another node.
    struct Divisor {
        Position base;
        Expression exponent; ///< a number above zero
    };
    std::optional<Divisor> power_below(const Subgraph::Item& item) const;

    /// Nodes between a row and its sources, these included, operands first.
    std::vector<Position> nodes_of(const Row& row);
    Expression rate_of(Position position) const;

    const Subgraph& part_;
    std::vector<Position> intermediates_;
    std::vector<bool> reaches_; ///< any variable
    std::vector<std::size_t> sources_;
    std::vector<Expression> weights_;       ///< derivatives of a row by nodes, or of nodes by a source
    std::priority_queue<Position> pending_; ///< nodes before their operands
    std::vector<bool> seen_;
};

} // namespace graze
