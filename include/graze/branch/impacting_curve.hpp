#pragma once

#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/special_point.hpp"

#include <vector>

namespace graze {

/// Returns the types of the curves of orbits with one more contact that end at a touch: `fold` at a fold-degenerate
/// touch, `flip` (for half orbits `asymmetry`) at a flip-degenerate one, and whichever of them end at a touch of
/// vanishing sensitivity. Empty elsewhere.
std::vector<PointType> impacting_curves_at(const System& system, const SpecialPoint& point);

/// Returns the point as a point of such a curve: its touch becomes a contact of zero speed, at which the equations of
/// orbits with a contact are regular, so that it can be BranchSettings::kept. The curve exists on one side only, that
/// of positive speeds.
/// @param settings of the curve; its parameter must move the touch
/// @throws InputError where no such curve ends, saying which points have one; or where the motion after the contact
/// does
/// not return to it
SpecialPoint on_impacting_curve(const System& system, const SpecialPoint& point, PointType type,
                                const BranchSettings& settings);

} // namespace graze
