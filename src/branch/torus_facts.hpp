#pragma once

#include "branch/torus_problem.hpp"

#include <span>

namespace graze {

/// Describes the torus with these unknowns, at which the problem is evaluated.
TorusFacts facts_of(const TorusProblem& problem, std::span<const double> u, const Simulation& simulation);

} // namespace graze
