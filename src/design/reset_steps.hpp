#pragma once

#include "graze/design/reset.hpp"

#include <span>

namespace graze {

/// Where a tripped motion is lost that is followed by simulation alone: one at rest, held by a stop as well as free,
/// and one that does not settle. The control parameter goes back in steps; at each the motion begins where it was last
/// and settles, or runs for as many returns as are allowed. It has been lost when it settles on the same motion as one
/// that has not tripped. That step is halved until its ends differ by a millionth of the way. What does not rest goes
/// back several times in steps of different lengths; of all of them come the nearest value at which it was there, and
/// the farthest at which it was lost. Other ways may lose it sooner or later.
/// @param system beyond the trip value, with the initial state from which the motion trips
/// @param settle how a motion settles
/// @return `lost_at` beside the value; no value but a reason where that could not be told, as when a motion ends
Reset reset_by_steps(const TripPoint& trip, const Orbit& orbit, const System& system, const AttractorOptions& settle,
                     const ResetOptions& options);

} // namespace graze
