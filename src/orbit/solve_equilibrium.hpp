#pragma once

#include "graze/orbit/solve.hpp"
#include "orbit/equilibrium_equations.hpp"

#include <Eigen/Core>

#include <complex>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// The orbit that stands for an equilibrium: one segment without duration.
Orbit orbit_of_rest(std::size_t mode, std::vector<double> state, std::vector<double> parameters);

/// Returns scales of the active states: their magnitudes and, where these are zero, magnitudes that follow from how
/// states act on one another.
/// @param hints sizes of all states that are known otherwise; may be empty, and zero for states without
Eigen::VectorXd scales_of_equilibrium(const EquilibriumEquations& equations, std::span<const double> state,
                                      std::span<const double> parameters, std::span<const double> hints);

/// Real parts of eigenvalues below this cannot be told from zero.
double neutral_growth(std::span<const std::complex<double>> eigenvalues);
/// Returns the eigenvalues of the linearised field, without those that sliding along surfaces adds: largest real part
/// first, then largest imaginary part. @param field in scales of the states
std::vector<std::complex<double>> sorted_eigenvalues(const EquilibriumEquations& equations,
                                                     const Eigen::MatrixXd& field);
/// The same at a state.
std::vector<std::complex<double>> eigenvalues_at(const EquilibriumEquations& equations, std::span<const double> state,
                                                 std::span<const double> parameters);
/// Returns the magnitude up to which an event's function cannot be told from zero, given round-off in it and in the
/// states. @param values of the function: its value, then derivatives with respect to states and parameters
double event_round_off(const Function& function, std::span<const double> inputs, std::span<const double> values,
                       std::size_t states);
/// Checks on which sides of the watched barriers an equilibrium lies.
Certificate certify_equilibrium(const EquilibriumEquations& equations, const Orbit& orbit);
/// Returns why a state at rest would not stay there: a clock acts on it; empty if none does.
std::string disturbed_by_clock(const EquilibriumEquations& equations, std::span<const double> state,
                               std::span<const double> parameters);

/// Finds an equilibrium near a state by Newton's method, damped so that simplified corrections shrink (P. Deuflhard,
/// "Newton Methods for Nonlinear Problems", 2004). Where equilibria form a family, the nearest one is found.
OrbitSolution solve_equilibrium(const System& system, const Orbit& candidate, const OrbitOptions& options);

} // namespace graze
