#pragma once

#include "orbit/orbit_equations.hpp"

#include <optional>

namespace graze {

/// Returns the first half of an orbit that is its own image under a symmetry of the model; empty if it is not.
/// @param equations of this or a similar orbit, whose scales measure differences
std::optional<Orbit> half_of(const OrbitEquations& equations, const Orbit& orbit, double tolerance);

} // namespace graze
