#pragma once

#include "graze/branch/switching.hpp"

#include <optional>

namespace graze {

/// Going on where two events change their order, a segment has vanished, or a guard chooses another mode: the orbit
/// just beyond with the signature that the model's own motion has there.
/// @throws InputError when there is none
BranchStart with_events_reordered(const System& system, const SpecialPoint& point, const BranchSettings& settings);

/// The model's own motion for one round near such a point of a curve, as a guess from which to go on: it need not
/// close.
/// @param distance along the curve, in units of its direction; negative: back
/// @param aside in the same units, from the curve along the branch in the first parameter: so that what is touched all
/// along is missed
/// @return none where it cannot be followed, or has the signature that the point has
std::optional<Orbit> reordered_beyond(const System& system, const SpecialPoint& point, const BranchSettings& settings,
                                      double distance, double aside);

} // namespace graze
