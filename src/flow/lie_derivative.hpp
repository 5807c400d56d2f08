#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Derivatives of functions of the states along the flow of a mode, symbolically.
/// @param model whose graph may grow; @param functions without definitions or dependent parameters (Model::expand)
/// @param rates of the states, likewise
std::vector<Expression> lie_derivatives(const Model& model, std::span<const Expression> functions,
                                        std::span<const Expression> rates);

/// Rate of an event's function along the flow of a mode, and the rate of that, and so on: as many as asked for.
std::vector<Expression> rates_of(const System& system, std::size_t mode, std::size_t event, std::size_t count);

/// The first of them.
Expression rate_of(const System& system, std::size_t mode, std::size_t event);

} // namespace graze
