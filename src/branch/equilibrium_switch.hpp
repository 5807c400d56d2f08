#pragma once

#include "graze/branch/switching.hpp"

#include <vector>

namespace graze {

/// Returns the other branch of equilibria through a branch point, in both directions, each from an equilibrium on it:
/// its direction solves the algebraic branching equation (H. B. Keller, 1977). @throws InputError where none is found
std::vector<BranchStart> equilibria_at_branch_point(const System& system, const SpecialPoint& point,
                                                    const BranchSettings& settings);

} // namespace graze
