#pragma once

#include "graze/symbolic/expression.hpp"
#include "graze/symbolic/symbol_index.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Exact partial derivative; may be applied any number of times. Time linear in the size of the graph below.
Expression differentiate(const Expression& expression, const Expression& symbol);
/// The same for several expressions, visiting shared parts once.
std::vector<Expression> differentiate(std::span<const Expression> expressions, const Expression& symbol);

/// All partial derivatives with respect to several symbols, row by row: expressions x symbols.
/// @throws InputError for a symbol that is named twice
std::vector<Expression> jacobian(std::span<const Expression> expressions, std::span<const Expression> symbols);
/// A partial derivative that is not 0 throughout.
struct JacobianEntry {
    std::size_t row = 0;    ///< of the expression
    std::size_t column = 0; ///< of the symbol
    Expression value{};
};
/// Those of several expressions, row by row, by rising column. Time goes by the size of each expression times the
/// number of symbols in it, not by that of all symbols.
std::vector<JacobianEntry> sparse_jacobian(std::span<const Expression> expressions, const SymbolIndex& symbols);
/// The derivative along a vector: the sum of the partial derivatives with respect to symbols, times the component of
/// each. Shared parts are visited once, whatever the number of components.
using Component = std::pair<Expression, Expression>; ///< symbol, component of the vector (any expression)
std::vector<Expression> differentiate_along(std::span<const Expression> expressions, std::span<const Component> vector);

/// Replaces symbols by expressions, all at once (replacements are not searched again).
using Replacement = std::pair<Expression, Expression>; ///< symbol, what replaces it
Expression substitute(const Expression& expression, std::span<const Replacement> replacements);
std::vector<Expression> substitute(std::span<const Expression> expressions, std::span<const Replacement> replacements);

/// The symbols that occur in the expressions, in the order of their indices.
std::vector<Expression> symbols_of(std::span<const Expression> expressions);

/// Infix text that parses back to the same expression (numbers with as many digits as they need), given that the
/// names of its symbols are valid. Time is linear in the length of the text, in which shared parts are repeated.
/// @throws InputError when that would be about 1e9 characters
std::string to_string(const Expression& expression);

} // namespace graze
