#pragma once

#include "orbit/orbit_equations.hpp"

#include <optional>

namespace graze {

/// The half of an orbit that is its own image under a symmetry of the model, or none if it is not.
/// @param shooting of that orbit, or one like it, whose scales measure differences
std::optional<Orbit> half_of(const OrbitEquations& equations, const Orbit& orbit, double tolerance);

} // namespace graze
