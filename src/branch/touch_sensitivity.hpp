#pragma once

#include "graze/orbit/orbit.hpp"
#include "graze/trajectory/simulation.hpp"

#include <cstddef>
#include <optional>

namespace graze {

/// What an impact makes of the next pass, where an orbit touches: the next least value of the event's function, divided
/// by the speed of an impact of vanishing speed. Beside the grazing everything depends on the root of the clearance,
/// and this is the coefficient of the root: where it is positive the next pass is free, where it is negative it hits
/// the harder. Where it is zero curves of folds and flips of the impacting orbits end on that of the touches (P. Thota,
/// X. Zhao and H. Dankowicz, "Co-dimension-two grazing bifurcations in single-degree-of-freedom impact oscillators",
/// J. Comput. Nonlinear Dynam. 1, 2006).
///
/// Extrapolated from impacts of several speeds that are followed for one round, as the model does.
/// @param orbit touches the event's surface within a segment, at a time since the segment's start
/// @return none where the motion after such an impact does not come back in a round, or the orbit is half of a whole
std::optional<double> touch_sensitivity(const Simulation& simulation, const Orbit& orbit, std::size_t segment,
                                        std::size_t event, double time);

} // namespace graze
