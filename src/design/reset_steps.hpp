#pragma once

#include "graze/design/reset.hpp"

namespace graze {

/// Finds the reset value of a motion that must be simulated: one at rest, or one that does not settle on an orbit. The
/// control parameter is taken back in steps; at each, the motion starts from its previous state and settles, or runs
/// for the allowed number of returns. It is lost when it settles on the same motion as one that has not tripped. That
/// step is bisected to 1e-6 of the way. A motion that is not at rest is taken back along several sequences of steps;
/// the result combines the nearest value at which it remained and the farthest at which it was lost. Other sequences
/// may lose it sooner or later.
/// @param system system beyond the trip value, whose initial state leads to the trip
/// @param settle options of the settling simulations
/// @return `value` and `lost_at`; or a reason without a value if they could not be found, as when a motion ends
Reset reset_by_steps(const TripPoint& trip, const Orbit& orbit, const System& system, const AttractorOptions& settle,
                     const ResetOptions& options);

} // namespace graze
