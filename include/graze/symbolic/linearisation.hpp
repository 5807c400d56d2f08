#pragma once

#include "graze/symbolic/expression.hpp"
#include "graze/symbolic/symbol_index.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// One product of a row: coefficient times what the source changes by.
struct LinearEntry {
    std::size_t row = 0, source = 0;
    Expression coefficient{};
    bool varies = false; ///< whether a state is in the coefficient; otherwise it is constant along a motion
};

/// The derivatives of functions along any direction, as sums of products. Rows 0 .. intermediates-1 are those of
/// intermediate quantities, each made of sources before it; then come the functions. Sources 0 .. variables-1 are the
/// variables, then come the intermediates.
struct Linearisation {
    /// What products cost, in products of numbers: one with a coefficient that varies is one of series. And what an
    /// intermediate costs besides its products, as it has to be kept.
    static constexpr std::size_t varying_cost = 8, constant_cost = 1, intermediate_cost = 2;

    std::size_t variables = 0, functions = 0, intermediates = 0;
    std::vector<LinearEntry> entries{}; ///< by rising row, then by rising source; none is zero throughout

    /// Entries whose coefficient varies.
    std::size_t varying_entries() const;
    /// Of one direction, by the costs above.
    std::size_t cost() const;
};

/// Derivatives of functions with respect to variables, in terms of variables. Quantities that many states enter, and
/// that enter many functions, become intermediates where directions in states then cost less, coefficients counted in:
/// n functions of a mean of n states take 2n products then, not n^2. Elsewhere entries are those of the sparse
/// Jacobian. Time and room go by the size of the functions where few of their parts are shared.
/// @param functions rates of states, say
/// @param variables states, then parameters
/// @param states    number of states among them. Parameters decide nothing about intermediates
/// @param directions that share coefficients, which take products of series to be formed, fewer with intermediates
/// @throws InputError for functions of several graphs, a variable of another, more states than variables, or
///         no directions, or more than a million
Linearisation linearise(std::span<const Expression> functions, const SymbolIndex& variables, std::size_t states,
                        std::size_t directions = 8);

} // namespace graze
