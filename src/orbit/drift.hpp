#pragma once

#include "graze/orbit/orbit.hpp"
#include "graze/trajectory/simulation.hpp"

namespace graze {

/// Lets drifting states begin each segment where the one before has left them. In an orbit that has been put together
/// from parts, such as one of twice the period, they begin each part anew; closed orbits do not care where they are,
/// but a solution of the equations has no such gaps, and one who looks for the nearest must not take them for a
/// distance.
void join_drifts(const Simulation& simulation, Orbit& orbit);

} // namespace graze
