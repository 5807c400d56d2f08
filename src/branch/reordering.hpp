#pragma once

#include "graze/branch/switching.hpp"

namespace graze {

/// Going on where two events change their order, a segment has vanished, or a guard chooses another mode: the orbit
/// just beyond with the signature that the model's own motion has there.
/// @throws InputError when there is none
BranchStart with_events_reordered(const System& system, const SpecialPoint& point, const BranchSettings& settings);

} // namespace graze
