#pragma once

#include "graze/symbolic/linearisation.hpp"
#include "symbolic/subgraph.hpp"

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace graze {

/// The graph through which changes of states propagate to functions, the roots of a subgraph. An edge from an operand
/// to an operation stands for a nonzero derivative and tells whether it varies with the states. Eliminating an
/// operation connects its operands directly to its users. Operations that are not eliminated are intermediate
/// quantities.
///
/// Finding the fewest products is NP-hard. This class eliminates operations while the cost does not rise, first those
/// with the fewest products (Markowitz 1957; for derivatives Griewank and Reese 1991, Griewank and Vogel 2005).
class LinearGraph {
public:
    /// @param has_state whether the node at each position of the subgraph depends on a state
    /// @param directions number of directions for which costs are counted
    LinearGraph(const Subgraph& part, const std::vector<bool>& has_state, std::size_t directions);

    /// Eliminates operations one by one while this does not raise the cost.
    void reduce();
    /// Eliminates connected groups of intermediates that, taken together, save nothing.
    /// @return true when a remaining group saves so little that cancelling derivatives, unknown here, may decide
    bool drop_useless();
    /// Returns the positions of the remaining intermediates, rising.
    std::vector<std::uint32_t> remaining() const;

private:
    using Vertex = std::uint32_t; ///< position in the subgraph; the functions follow after the last position
    struct Candidate {
        std::size_t products;
        Vertex vertex;
        std::uint32_t version;
        /// The queue returns its largest element: the fewest products, then the vertex nearest to the functions, so
        /// that a long sum is taken apart from its end, one term at a time.
        bool operator<(const Candidate& other) const {
            return products != other.products ? products > other.products : vertex < other.vertex;
        }
    };
    struct Neighbour {
        Vertex vertex;
        bool varies;
    };
    /// Intermediates and functions that are connected by paths that do not pass through states.
    struct Group {
        std::vector<Vertex> functions;
        std::size_t cost = 0;
    };

    std::size_t cost_of(bool varies) const { return varies ? cost_of_varying_ : cost_of_constant_; }
    void connect_operands(Vertex vertex, const std::vector<bool>& has_state);
    void connect(Vertex from, Vertex to, bool varies);
    bool is_intermediate(Vertex vertex) const { return !eliminated_[vertex] && !fixed_[vertex]; }
    std::size_t products(Vertex vertex) const { return std::size_t{operands_left_[vertex]} * users_left_[vertex]; }
    /// Return the operands or users that are not eliminated, and whether the connecting edges vary.
    std::vector<Neighbour> operands_of(Vertex vertex);
    std::vector<Neighbour> users_of(Vertex vertex);
    bool pays(const std::vector<Neighbour>& operands, const std::vector<Neighbour>& users) const;
    /// Tries each intermediate once. @return true when any was eliminated
    bool reduce_once();
    bool eliminate_if_it_pays(Vertex vertex);
    std::vector<Group> groups(std::vector<std::uint32_t>& group_of);
    /// Returns the cost of a function when all intermediates are eliminated; adds the edges visited to `work`.
    std::size_t plain_cost(Vertex function, std::size_t& work);

    static constexpr std::uint64_t key(Vertex from, Vertex to) { return (std::uint64_t{from} << 32) | to; }

    std::size_t cost_of_intermediate_, cost_of_constant_, cost_of_varying_;
    std::size_t nodes_;
    const Subgraph& part_;
    std::vector<std::vector<Vertex>> operands_, users_; ///< may still contain eliminated vertices
    std::vector<std::uint32_t> operands_left_, users_left_, versions_;
    std::vector<bool> eliminated_, fixed_;
    std::unordered_map<std::uint64_t, bool> varies_; ///< of every edge that has existed
    enum class Reached : std::uint8_t { no, constantly, varying };
    std::vector<Reached> reached_; ///< workspace of plain_cost
};

} // namespace graze
