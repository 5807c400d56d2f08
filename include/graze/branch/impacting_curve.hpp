#pragma once

#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/special_point.hpp"

#include <vector>

namespace graze {

/// What curves of orbits with one contact more end at a touch, as types of their points: `fold` where that is
/// fold-degenerate, `flip` (of half orbits `asymmetry`) where it is flip-degenerate, and those of them that end where
/// an impact does not act on the next pass. Empty elsewhere.
std::vector<PointType> impacting_curves_at(const System& system, const SpecialPoint& point);

/// The point as one of such a curve: its touch has become a contact without speed, at which equations of orbits with a
/// contact are regular, so that BranchSettings::kept can hold it. The curve leads one way only, that of positive
/// speeds.
/// @param settings of the curve: its parameter moves the touch
/// @throws InputError where no such curve ends, saying what could be asked; or where the motion after the contact does
///         not come back to it
SpecialPoint on_impacting_curve(const System& system, const SpecialPoint& point, PointType type,
                                const BranchSettings& settings);

} // namespace graze
