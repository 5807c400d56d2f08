#pragma once

#include <cstddef>
#include <vector>

namespace graze {

/// A term of the first variational equations of a mode: a coefficient that varies along the motion, times the change of
/// its source.
struct TangentEntry {
    std::size_t row = 0;      ///< intermediate quantities first, then the rates of states
    std::size_t source = 0;   ///< states first, then parameters, then intermediate quantities
    std::size_t deferred = 0; ///< index of the coefficient among the deferred expressions of the mode's tape
};

/// The first variational equations of a mode: the change of each rate with states and parameters, through intermediate
/// quantities where these save products. An intermediate quantity depends only on sources before it.
struct TangentEquations {
    std::size_t states = 0, parameters = 0, intermediates = 0;
    std::vector<TangentEntry> entries; ///< by rising row
};

} // namespace graze
