#pragma once

#include "graze/flow/system.hpp"
#include "graze/symbolic/transform.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// A symbol in the model's graph whose name the model does not have.
Expression new_symbol(Model& model, const std::string& base);

/// The modes of a model alone, with derivatives of the states as states like others: x' = f, w' = the derivative of f
/// along w. First the model's states, then column by column those of the rows.
/// @param rows states that derivatives are of
/// @param columns of each the vector along which it is the derivative: first the components of the rows, in their
///        order, then others, which become parameters
System modes_with_tangents(Model& model, std::span<const std::size_t> rows,
                           std::span<const std::vector<Component>> columns);

} // namespace graze
