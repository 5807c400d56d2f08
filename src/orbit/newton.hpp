#pragma once

#include "graze/orbit/solve.hpp"
#include "orbit/shooting.hpp"

namespace graze {

/// How orbits are integrated. @param tolerance raised to the smallest that makes sense
SimulationOptions integration(double tolerance);
/// Newton's method for a shooting problem without free parameters. The equations are left evaluated at `unknowns`.
OrbitOutcome solve_shooting(Shooting& shooting, Eigen::VectorXd& unknowns, const OrbitOptions& options,
                            std::size_t& iterations, std::string& detail);
/// Everything that is known of an orbit at which the equations have been evaluated: multipliers and certificate.
void describe_orbit(Shooting& shooting, const Eigen::VectorXd& unknowns, OrbitSolution& solution);

} // namespace graze
