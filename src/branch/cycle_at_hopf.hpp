#pragma once

#include "branch/point_kind.hpp"

namespace graze {

/// Returns the branch of cycles that begins at a Hopf point of an equilibrium: from a small cycle on it, away from the
/// point. From the end of a branch of cycles at a Hopf point, the branch of equilibria, in both directions.
PointRule::Leave leave_hopf;

/// Returns a Hopf point at the end of a branch of cycles as one of its equilibrium; others are returned unchanged.
/// @throws InputError where the equilibrium is not found
SpecialPoint hopf_of_equilibrium(const System& system, const SpecialPoint& point);

} // namespace graze
