#pragma once

#include "graze/orbit/solve.hpp"
#include "orbit/certify.hpp"
#include "orbit/orbit_equations.hpp"

namespace graze {

/// Returns the simulation options for integrating orbits. @param tolerance raised to smallest_tolerance if below it
SimulationOptions integration(double tolerance);
/// @throws InputError unless Newton's method can reach the accuracy: 1e-15 .. 1e-2
void require_accuracy(double accuracy);
/// Solves equations without free parameters by damped Newton's method.
/// @param at set to the evaluation at the last iterate; its `unknowns` are empty if the equations are undefined there
OrbitOutcome solve_equations(OrbitEquations& equations, Eigen::VectorXd& unknowns, const OrbitOptions& options,
                             OrbitEvaluation& at, std::size_t& iterations, std::string& detail);
/// Sets residual, multipliers and certificate of a solution from an evaluation of its equations.
/// @param held constraint at the limit of admissibility, if any
void describe_orbit(OrbitEquations& equations, const OrbitEvaluation& at, OrbitSolution& solution,
                    const std::optional<HeldLimit>& held = std::nullopt);

} // namespace graze
