#pragma once

#include "graze/branch/switching.hpp"

#include <optional>

namespace graze {

/// Returns the start of the branch beyond a point where two events change their order, a segment vanishes or a guard
/// chooses another mode: an orbit with the signature of the model's motion there.
/// @throws InputError when no orbit is found
BranchStart with_events_reordered(const System& system, const SpecialPoint& point, const BranchSettings& settings);

/// Returns the motion of the model for one period near such a point of a curve, as a first guess; it need not close.
/// @param distance along the curve, in units of its tangent; negative: backwards
/// @param aside offset from the curve in the first parameter, in the same units, so that the kept touch is missed or
/// made
/// @return empty where the motion cannot be followed or has the signature of the point
std::optional<Orbit> reordered_beyond(const System& system, const SpecialPoint& point, const BranchSettings& settings,
                                      double distance, double aside);

} // namespace graze
