#pragma once

#include "graze/orbit/solve.hpp"

#include <functional>
#include <vector>

namespace graze {

/// Finds orbits that are homoclinic to a saddle cycle with one unstable direction. The unstable manifold is followed
/// from one fundamental domain, beside the cycle, by the model's own motion. Where the unstable coordinate of
/// neighbours that have come back has different signs, an orbit between them may come back in the stable manifold; it
/// is enclosed for as long as it approaches the cycle, then solved for. On either side of the cycle those orbits are
/// found that come back after the fewest turns. Orbits along which manifolds touch are on neither side and not found.
/// @param cycle a periodic orbit; of a half orbit, the whole is used
/// @param interrupted called now and then; returns true to stop
/// @return the orbits, with `Orbit::cycle` set, in the order in which they come back; fewer when interrupted
/// @throws InputError when the orbit is no such cycle, and when none is found
std::vector<OrbitSolution> homoclinic_orbits(const System& system, const Orbit& cycle, const OrbitOptions& options = {},
                                             const std::function<bool()>& interrupted = {});

} // namespace graze
