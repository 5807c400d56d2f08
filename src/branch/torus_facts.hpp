#pragma once

#include "branch/torus_problem.hpp"
#include "graze/branch/monitor.hpp"

#include <span>
#include <vector>

namespace graze {

/// Describes the torus with these unknowns, at which the problem is evaluated.
TorusFacts facts_of(const TorusProblem& problem, std::span<const double> u, const Simulation& simulation);

/// Returns the extremes over the whole torus of monitors of the kinds `maximum` and `minimum`.
std::vector<double> extremes_of(const TorusProblem& problem, std::span<const double> u, OrbitMonitors& monitors);

} // namespace graze
