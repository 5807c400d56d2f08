#pragma once

#include "graze/orbit/solve.hpp"
#include "orbit/certify.hpp"

namespace graze {

/// Returns the simulation options for integrating orbits. @param tolerance raised to smallest_tolerance if below it
SimulationOptions integration(double tolerance);
/// @throws InputError unless Newton's method can reach the accuracy: 1e-15 .. 1e-2
void require_accuracy(double accuracy);
/// @throws InputError unless integration can keep the relative error of each step: 1e-16 .. 1e-2
void require_tolerance_in_range(double tolerance);
/// Solves equations without free parameters by damped Newton's method.
/// @param at set to the evaluation at the last iterate; its `unknowns` are empty if the equations are undefined there
/// @param undetermined number of directions that the equations leave undetermined, if that is known beforehand
OrbitOutcome solve_equations(OrbitEquations& equations, Eigen::VectorXd& unknowns, const OrbitOptions& options,
                             OrbitEvaluation& at, std::size_t& iterations, std::string& detail,
                             std::size_t undetermined = 0);
enum class Spectrum {
    all,
    leading ///< of models with many states, those outside a circle if it can be shown that they are all
};
/// Sets residual, multipliers and certificate of a solution from an evaluation of its equations.
/// @param held constraint at the limit of admissibility, if any; @param spectrum which multipliers are wanted
void describe_orbit(OrbitEquations& equations, const OrbitEvaluation& at, OrbitSolution& solution,
                    const std::optional<HeldLimit>& held = std::nullopt, Spectrum spectrum = Spectrum::all);
/// Marks that many multipliers as those of a family: the nearest to 1 are set to 1.
void mark_neutral(OrbitSolution& solution, std::size_t count);
/// True when an orbit belongs to a family of orbits at the same parameters, as in models that conserve a quantity: its
/// equations are singular, and displaced along the null vector Newton's method converges to another orbit there, whose
/// equations are singular too. At folds and branch points such orbits exist only at other parameters, or not at all.
/// @param equations without free parameters; @param at their evaluation at the orbit
bool is_in_family(OrbitEquations& equations, const OrbitEvaluation& at);
/// Shifts the drifting states of each start to where the segment before ends. An orbit composed of parts, such as one
/// of twice the period, has gaps in its drifting states. The orbit does not depend on them, but a search for the
/// nearest solution would count the gaps as a distance.
void join_drifts(const Simulation& simulation, Orbit& orbit);
/// Returns the first half of an orbit that is its own image under a symmetry of the model; empty if it is not.
/// @param equations of this or a similar orbit, whose scales measure differences
std::optional<Orbit> half_of(const OrbitEquations& equations, const Orbit& orbit, double tolerance);

} // namespace graze
