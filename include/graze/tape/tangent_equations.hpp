#pragma once

#include <cstddef>
#include <vector>

namespace graze {

/// A product in the first variational equations of a mode: a coefficient that goes with the motion, times the change
/// of what it depends on.
struct TangentEntry {
    std::size_t row = 0;      ///< intermediate quantities first, then states, whose rates change
    std::size_t source = 0;   ///< states first, then parameters, then intermediate quantities
    std::size_t follower = 0; ///< of the mode's tape, whose series the coefficient is
};

/// The first variational equations of a mode: how rates change with states and parameters, by way of intermediate
/// quantities where these save products. An intermediate quantity has sources before it alone.
struct TangentEquations {
    std::size_t states = 0, parameters = 0, intermediates = 0;
    std::vector<TangentEntry> entries; ///< by rising row
};

} // namespace graze
