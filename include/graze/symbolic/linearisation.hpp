#pragma once

#include "graze/symbolic/expression.hpp"
#include "graze/symbolic/symbol_index.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// One term of a row: coefficient times the change of the source.
struct LinearEntry {
    std::size_t row = 0, source = 0;
    Expression coefficient{};
    bool varies = false; ///< the coefficient depends on a state; otherwise it is constant along a motion
};

/// The directional derivatives of functions as sums of products. Rows 0 .. intermediates-1 belong to intermediate
/// quantities, each a combination of earlier sources; the rows of the functions follow. Sources 0 .. variables-1 are
/// the variables; the intermediates follow.
struct Linearisation {
    /// Costs of a product with a varying coefficient (a product of series), of a product with a constant coefficient,
    /// and of storing an intermediate, in units of one multiplication of numbers.
    static constexpr std::size_t varying_cost = 8, constant_cost = 1, intermediate_cost = 2;

    std::size_t variables = 0, functions = 0, intermediates = 0;
    std::vector<LinearEntry> entries{}; ///< by rising row, then by rising source; none is identically zero

    /// Returns the number of entries whose coefficient varies.
    std::size_t varying_entries() const;
    /// Returns the cost of one direction, in the units above.
    std::size_t cost() const;
};

/// Differentiates functions with respect to variables. A quantity on which many states act and that acts on many
/// functions becomes an intermediate if this reduces the cost of directions in state space, coefficients included: n
/// functions of a mean of n states then need 2n products, not n^2. The other entries are those of the sparse Jacobian.
/// Time and memory are proportional to the size of the functions if few of their parts are shared.
/// @param functions for example the rates of states
/// @param variables states, then parameters
/// @param states number of states among the variables. Parameters do not affect the choice of intermediates
/// @param directions number of directions that share the coefficients; forming coefficients costs products of series,
/// and intermediates need fewer of them
/// @throws InputError for functions of several graphs, a variable of another graph, more states than
/// variables, or a number of directions outside 1 .. 10^6
Linearisation linearise(std::span<const Expression> functions, const SymbolIndex& variables, std::size_t states,
                        std::size_t directions = 8);

} // namespace graze
