#pragma once

#include "graze/orbit/solve.hpp"
#include "orbit/certify.hpp"
#include "orbit/orbit_equations.hpp"

namespace graze {

/// How orbits are integrated. @param tolerance raised to the smallest that makes sense
SimulationOptions integration(double tolerance);
/// Newton's method for equations without free parameters, damped where it would overshoot.
/// @param at their evaluation at the last iterate, which is also its `unknowns` unless they are undefined there
OrbitOutcome solve_equations(OrbitEquations& equations, Eigen::VectorXd& unknowns, const OrbitOptions& options,
                             OrbitEvaluation& at, std::size_t& iterations, std::string& detail);
/// Everything that is known of an orbit from an evaluation of its equations: multipliers and certificate.
/// @param held to what it is held
void describe_orbit(OrbitEquations& equations, const OrbitEvaluation& at, OrbitSolution& solution,
                    const std::optional<HeldLimit>& held = std::nullopt);

} // namespace graze
