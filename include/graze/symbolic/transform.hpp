#pragma once

#include "graze/symbolic/expression.hpp"

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
std::vector<Expression> jacobian(std::span<const Expression> expressions, std::span<const Expression> symbols);
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
/// @throws std::length_error when that would be about 1e9 characters
std::string to_string(const Expression& expression);

} // namespace graze
