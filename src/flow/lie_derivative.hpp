#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Returns derivatives of functions of the states along the flow of a mode, symbolically. The model's graph may grow.
/// @param functions, rates without definitions or dependent parameters (Model::expand)
std::vector<Expression> lie_derivatives(const Model& model, std::span<const Expression> functions,
                                        std::span<const Expression> rates);

/// Returns the rate of an event's function along the flow of a mode, the rate of that rate, and so on: `count` of them.
std::vector<Expression> rates_of(const System& system, std::size_t mode, std::size_t event, std::size_t count);

/// Returns the rate of an event's function along the flow of a mode.
Expression rate_of(const System& system, std::size_t mode, std::size_t event);

} // namespace graze
