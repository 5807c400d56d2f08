#pragma once

#include "graze/flow/system.hpp"
#include "graze/symbolic/transform.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Returns a symbol in the model's graph whose name the model does not use.
Expression new_symbol(Model& model, const std::string& base);

/// Returns the modes of a model without events, extended by derivatives of the states as further states: x' = f, w' =
/// the derivative of f along w. States: first those of the model, then, column by column, the derivatives of `rows`.
/// @param rows states whose derivatives are computed
/// @param columns for each column, the vector along which it is the derivative: first the components of the rows, in
/// their order, then others, which become parameters
System modes_with_tangents(Model& model, std::span<const std::size_t> rows,
                           std::span<const std::vector<Component>> columns);

} // namespace graze
