#pragma once

#include "branch/torus_problem.hpp"
#include "graze/branch/monitor.hpp"

#include <span>
#include <vector>

namespace graze {

/// Describes the torus with these unknowns, at which the problem is evaluated.
TorusFacts facts_of(const TorusProblem& problem, std::span<const double> u, const Simulation& simulation);

/// Returns the largest error of the circle's image at angles between those at which the equations hold, beyond
/// round-off, relative to the largest harmonic. Where the map has a symmetry of many turns, harmonics that the
/// equations cannot tell from lower ones may be missing although the last ones vanish.
double misfit_between(const TorusProblem& problem, std::span<const double> u);

/// Returns the extremes over the whole torus of monitors of the kinds `maximum` and `minimum`.
std::vector<double> extremes_of(const TorusProblem& problem, std::span<const double> u, OrbitMonitors& monitors);

} // namespace graze
