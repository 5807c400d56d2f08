#pragma once

#include "branch/torus_problem.hpp"
#include "graze/branch/monitor.hpp"
#include "graze/branch/torus_branch.hpp"

#include <span>
#include <vector>

namespace graze {

/// Describes the torus with these unknowns, at which the problem is evaluated.
TorusFacts facts_of(const TorusProblem& problem, std::span<const double> u, const Simulation& simulation);

/// True when a circle has all harmonics that it needs: the last ones are small, and its image is on it at angles
/// between those at which the equations hold. Where the map has a symmetry of many turns, harmonics that the equations
/// cannot tell from lower ones may be missing although the last ones vanish.
bool is_resolved(const TorusProblem& problem, std::span<const double> u, const TorusResolution& resolution);

/// Returns the extremes over the whole torus of monitors of the kinds `maximum` and `minimum`.
std::vector<double> extremes_of(const TorusProblem& problem, std::span<const double> u, OrbitMonitors& monitors);

} // namespace graze
