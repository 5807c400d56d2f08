#pragma once

#include "graze/tape/tangent_equations.hpp"
#include "graze/tape/tape.hpp"

#include <cstdint>
#include <vector>

namespace graze {

/// The first variational equations of a mode, compiled beside its tape: how rates and watched events change with states
/// and parameters.
struct LinearMode {
    /// That of the mode, bit for bit, with coefficients of the equations as followers.
    Tape tape;
    TangentEquations equations;
    /// Derivatives of the watched events' functions: rows are events in the mode's sequence.
    std::vector<TangentEntry> events;

    /// Groups of followers: coefficients by states, derivatives of events, and coefficients by each parameter.
    static constexpr std::uint32_t by_states = 0, of_events = 1;
    static constexpr std::uint32_t by_parameter(std::size_t parameter) {
        return 2 + static_cast<std::uint32_t>(parameter);
    }
};

} // namespace graze
