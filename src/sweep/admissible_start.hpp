#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// The state nearest to one that lies behind barriers of its mode: on their surfaces, by Newton's method along their
/// gradients. Clocks stay as they are.
/// @return nothing where no state is found on the admissible side of all
std::optional<std::vector<double>> nearest_admissible(const System& system, std::span<const double> parameters,
                                                      std::span<const double> state, std::size_t mode);

} // namespace graze
