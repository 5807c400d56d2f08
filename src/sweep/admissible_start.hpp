#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// Returns the admissible state nearest to a state that violates barriers of its mode: a state on their surfaces, by
/// Newton's method along their gradients. Clocks are unchanged.
/// @return nothing if no state on the admissible side of all barriers is found
std::optional<std::vector<double>> nearest_admissible(const System& system, std::span<const double> parameters,
                                                      std::span<const double> state, std::size_t mode);

} // namespace graze
