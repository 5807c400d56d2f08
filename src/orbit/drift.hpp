#pragma once

#include "graze/orbit/orbit.hpp"
#include "graze/trajectory/simulation.hpp"

namespace graze {

/// Shifts the drifting states of each start to where the segment before ends. An orbit composed of parts, such as one
/// of twice the period, has gaps in its drifting states. The orbit does not depend on them, but a search for the
/// nearest solution would count the gaps as a distance.
void join_drifts(const Simulation& simulation, Orbit& orbit);

} // namespace graze
