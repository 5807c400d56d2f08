#pragma once

#include "graze/orbit/solve.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// The equilibria of a mode in a box of states.
struct EquilibriumSearch {
    /// Proven to exist, sorted by their states.
    std::vector<OrbitSolution> found;
    /// Where it could not be decided whether there is one, or how many: a converged solution if Newton's method leads
    /// to one there, otherwise the middle of the box. At a fold two equilibria coincide.
    std::vector<OrbitSolution> undecided;
    bool complete = false; ///< it is proven that there are no others
    bool interrupted = false;
    std::string condition; ///< " at x = 1": values of states that do not move, for which this holds; empty if all do
    std::string problem;   ///< why the mode has none, or why the search is not complete
};

/// Finds all equilibria of a mode in a box of its active states, by interval arithmetic: see find_zeros.
/// @param within ranges of states; cyclic states without one take all their values
/// @param state values of the states that are not active
/// @throws InputError for an active state without a range
EquilibriumSearch all_equilibria(const System& system, std::size_t mode, std::span<const StateBounds> within,
                                 std::span<const double> state, std::span<const double> parameters,
                                 const OrbitOptions& options, const std::function<bool()>& interrupted = {});

} // namespace graze
