#pragma once

#include "graze/symbolic/expression.hpp"

#include <vector>

namespace graze {

/// Rows of expressions.
using ExpressionMatrix = std::vector<std::vector<Expression>>;

/// Eliminates the columns of a matrix with further columns of right-hand sides. Matrices of inertia need no exchange of
/// rows for stability; a pivot that is identically zero is exchanged. @return the determinant
Expression eliminate(ExpressionMatrix& rows, const Expression& one);
/// Returns the determinant of a small square matrix, by expansion: no division, so that any value may be zero.
Expression determinant(const ExpressionMatrix& rows, const Expression& one);

} // namespace graze
