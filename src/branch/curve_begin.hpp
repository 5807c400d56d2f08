#pragma once

#include "graze/branch/orbit_branch.hpp"

namespace graze {

/// What a curve begins with: an orbit, and settings whose point is kept in that orbit.
struct CurveBegin {
    Orbit orbit;
    BranchSettings settings;
};

/// The same orbit, with the same touch, in equations that stay regular along a curve of touches. A contact without
/// speed that nothing comes of, as that of a soft stop which is left at once, is a touch within one segment: that its
/// segment of no time ends at all is no equation. And a touch where a motion without contacts is closed, as at a
/// greatest value that is the section too, lies within the motion that begins elsewhere.
/// @return what was given where nothing is to be changed
CurveBegin begun_for_curve(const System& system, const Orbit& orbit, const BranchSettings& settings);

} // namespace graze
