#pragma once

#include "branch/locked_curve.hpp"
#include "branch/torus_problem.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// Returns the unknowns of a torus beside a tongue, as far as the orbits within it tell. Where the parameter differs by
/// delta from that of an orbit, the motion moves on along the curve of orbits by drift * delta, after all returns of
/// the orbit. So it goes around in the time that these displacements add up to, and its angle grows in proportion to
/// it (as in R. Adler, Proc. IRE 34, 1946, for one wave of delta around the circle).
/// @param problem whose unknowns are returned @param curve that is closed @param parameter outside the tongue
/// @param across share of the first-order change of the circle across itself: 1; less where the circle bends
/// @return none where displacements have both directions
std::optional<std::vector<double>> torus_beyond(const TorusProblem& problem, const LockedCurve& curve,
                                                const Resonance& resonance, double parameter, double across);

/// Returns the number of harmonics that a torus beside a tongue needs, if the displacements along the circle are one
/// wave for each of the orbit's returns.
double harmonics_beyond(const LockedCurve& curve, const Resonance& resonance, double parameter, double tail);

} // namespace graze
