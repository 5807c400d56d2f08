#pragma once

#include "graze/tape/tangent_equations.hpp"
#include "graze/tape/tape.hpp"

#include <cstdint>
#include <vector>

namespace graze {

/// The first variational equations of a mode, compiled with its tape: derivatives of rates and watched events with
/// respect to states and parameters.
struct LinearMode {
    /// The mode's tape, equal bit for bit, with the coefficients of the equations as deferred expressions.
    Tape tape;
    TangentEquations equations;
    /// Derivatives of the watched events' functions: rows are events in the order of the mode.
    std::vector<TangentEntry> events;

    /// Groups of deferred expressions: coefficients of states, derivatives of events, and coefficients of each
    /// parameter.
    static constexpr std::uint32_t by_states = 0, of_events = 1;
    static constexpr std::uint32_t by_parameter(std::size_t parameter) {
        return 2 + static_cast<std::uint32_t>(parameter);
    }
};

} // namespace graze
