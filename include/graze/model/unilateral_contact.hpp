#pragma once

#include "graze/symbolic/expression.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// What an impact does to the velocities if several contacts are closed or close at once.
enum class ImpactLaw {
    newton,   ///< all at once: contacts that take an impulse separate at -e times their velocity of approach
    moreau,   ///< the same, and friction acts against the mean velocity, weighted by e, instead of the one after
    poisson,  ///< all at once: compression, then expansion with e times the impulses of compression
    sequence, ///< one after another, in the order of the file, until none approaches
};

/// A declaration: two bodies cannot penetrate each other. `Model::complete` makes an event for it, jumps, and the modes
/// in which contacts are closed.
struct UnilateralContact {
    std::string name{}, text{};
    Expression gap{};                     ///< distance, positive while the contact is open
    Expression restitution{};             ///< e of the impact law
    std::optional<Expression> friction{}; ///< coefficient; none: smooth
    std::optional<Expression> slip{};     ///< with friction: tangential velocity of the bodies along each other
};

/// What the contacts of a model have in common.
struct ContactSettings {
    ImpactLaw law = ImpactLaw::newton;
    std::vector<std::size_t> velocities{}; ///< states that impulses change
    /// The mass matrix: its diagonal, or all rows, one after another.
    std::vector<Expression> mass{};
    std::optional<std::vector<std::size_t>> modes{}; ///< in which the contacts exist; none: all that are written
};

} // namespace graze
