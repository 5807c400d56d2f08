#pragma once

#include "graze/symbolic/linearisation.hpp"
#include "symbolic/subgraph.hpp"

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace graze {

/// How the changes of states pass through the operations of a subgraph to functions, its roots: an edge from an operand
/// to an operation says that there is a derivative, and whether it varies with the states. To eliminate an operation is
/// to pass the changes of its operands on to its users at once. What is not eliminated is an intermediate quantity.
///
/// Fewest products are an NP-hard aim. Here operations are eliminated while that makes none dearer, first those with
/// the fewest products to be formed (Markowitz 1957; for derivatives Griewank and Reese 1991, Griewank and Vogel 2005).
class LinearGraph {
public:
    /// @param moves whether a state is in the node at each position of the subgraph
    /// @param directions of which costs are counted
    LinearGraph(const Subgraph& part, const std::vector<bool>& moves, std::size_t directions);

    void reduce();
    /// Eliminates those too that belong together and, taken together, save nothing.
    /// @return whether others save so little that it depends on derivatives that cancel, of which nothing is known here
    bool drop_useless();
    /// Positions of the operations that remain, rising.
    std::vector<std::uint32_t> remaining() const;

private:
    using Vertex = std::uint32_t; ///< position in the subgraph; functions come after all of these
    struct Candidate {
        std::size_t products;
        Vertex vertex;
        std::uint32_t version;
        /// Of two the last is that with fewest products, the one nearer to the functions of those: a long sum is then
        /// taken apart from its end, a term at a time.
        bool operator<(const Candidate& other) const {
            return products != other.products ? products > other.products : vertex < other.vertex;
        }
    };
    struct Neighbour {
        Vertex vertex;
        bool varies;
    };
    /// Intermediates and functions that are connected other than through states.
    struct Group {
        std::vector<Vertex> functions;
        std::size_t cost = 0;
    };

    std::size_t cost_of(bool varies) const { return varies ? cost_of_varying_ : cost_of_constant_; }
    void connect_operands(Vertex vertex, const std::vector<bool>& moves);
    void connect(Vertex from, Vertex to, bool varies);
    bool is_intermediate(Vertex vertex) const { return !eliminated_[vertex] && !fixed_[vertex]; }
    std::size_t products(Vertex vertex) const { return std::size_t{operands_left_[vertex]} * users_left_[vertex]; }
    /// Those that are still there, with what connects them.
    std::vector<Neighbour> operands_of(Vertex vertex);
    std::vector<Neighbour> users_of(Vertex vertex);
    bool pays(const std::vector<Neighbour>& operands, const std::vector<Neighbour>& users) const;
    /// One round through all that may be eliminated. @return whether anything was
    bool reduce_once();
    bool eliminate_if_it_pays(Vertex vertex);
    std::vector<Group> groups(std::vector<std::uint32_t>& group_of);
    /// Of a function, when nothing remains.
    std::size_t plain_cost(Vertex function, std::size_t& work);

    static constexpr std::uint64_t key(Vertex from, Vertex to) { return (std::uint64_t{from} << 32) | to; }

    std::size_t cost_of_intermediate_, cost_of_constant_, cost_of_varying_;
    std::size_t nodes_;
    const Subgraph& part_;
    std::vector<std::vector<Vertex>> operands_, users_; ///< those that are eliminated may still be among them
    std::vector<std::uint32_t> operands_left_, users_left_, versions_;
    std::vector<bool> eliminated_, fixed_;
    std::unordered_map<std::uint64_t, bool> varies_; ///< of every edge that there has been
    enum class Reached : std::uint8_t { no, constantly, varying };
    std::vector<Reached> reached_; ///< room for plain_cost
};

} // namespace graze
