#pragma once

#include "graze/symbolic/expression.hpp"
#include "graze/symbolic/symbol_index.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Returns the exact partial derivative. Time is linear in the number of nodes on which the expression depends.
Expression differentiate(const Expression& expression, const Expression& symbol);
/// The same for several expressions; shared nodes are visited once.
std::vector<Expression> differentiate(std::span<const Expression> expressions, const Expression& symbol);

/// Returns all partial derivatives with respect to several symbols, row by row: expressions x symbols.
/// @throws InputError when a symbol occurs twice
std::vector<Expression> jacobian(std::span<const Expression> expressions, std::span<const Expression> symbols);
/// A partial derivative that is not identically 0.
struct JacobianEntry {
    std::size_t row = 0;    ///< index of the expression
    std::size_t column = 0; ///< index of the symbol
    Expression value{};
};
/// Returns the nonzero partial derivatives, row by row, by rising column. Time is proportional to the size of each
/// expression times the number of symbols in it, not to the number of all symbols.
std::vector<JacobianEntry> sparse_jacobian(std::span<const Expression> expressions, const SymbolIndex& symbols);
/// Returns the directional derivatives: the sum over symbols of the partial derivative times the component of the
/// vector. Shared nodes are visited once, whatever the number of components.
using Component = std::pair<Expression, Expression>; ///< symbol, component of the vector (any expression)
std::vector<Expression> differentiate_along(std::span<const Expression> expressions, std::span<const Component> vector);

/// Replaces symbols by expressions, all at once (replacements are not searched for symbols again).
using Replacement = std::pair<Expression, Expression>; ///< symbol, what replaces it
Expression substitute(const Expression& expression, std::span<const Replacement> replacements);
std::vector<Expression> substitute(std::span<const Expression> expressions, std::span<const Replacement> replacements);

/// Returns the symbols that occur in the expressions, by rising index.
std::vector<Expression> symbols_of(std::span<const Expression> expressions);

/// Returns infix text that parses back to the same expression, provided that the names of its symbols are valid;
/// numbers have as many digits as they need. Time is linear in the length of the text, which repeats shared parts.
/// @throws InputError when the text would have about 1e9 characters
std::string to_string(const Expression& expression);

} // namespace graze
