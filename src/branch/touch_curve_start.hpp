#pragma once

#include "graze/branch/orbit_branch.hpp"

namespace graze {

/// The start of a curve: an orbit, and settings whose kept point refers to this orbit.
struct CurveStart {
    Orbit orbit;
    BranchSettings settings;
};

/// Returns the same orbit and touch in a representation whose equations stay regular along a curve of touches. A
/// contact of zero speed without effect, such as that of a soft stop that is left at once, becomes a touch inside one
/// segment, because the end of a segment of zero duration is not a regular equation. An orbit without contacts whose
/// start coincides with a touch gets another start.
/// @return the arguments where no change is needed
CurveStart start_of_curve(const System& system, const Orbit& orbit, const BranchSettings& settings);

} // namespace graze
