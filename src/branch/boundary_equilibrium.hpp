#pragma once

#include "branch/equilibrium_problem.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// An equilibrium of another mode that meets one of this mode at the surface of an event.
struct MeetingEquilibrium {
    Orbit orbit;
    /// Directions of the branch parameter in which it is admissible: +1, -1; 0 if neither or not known.
    int admissible = 0;
};

/// Returns true when an event in a mode changes the motion, so that an equilibrium at its surface is a special point.
bool changes_motion(const Model& model, std::size_t mode, std::size_t event);

/// Returns the equilibria of other modes at a boundary equilibrium: where a transition at the event, the end of an
/// accumulation there, or a transition back leads to a mode whose field vanishes too.
/// @param orbit the equilibrium at the surface
std::vector<MeetingEquilibrium> meeting_equilibria(const System& system, const Orbit& orbit, std::size_t event,
                                                   const BranchSettings& settings);

/// Returns the direction of the branch parameter in which the equilibrium moves to the admissible side of the event.
int admissible_direction(const EquilibriumEvaluation& at, std::size_t event);

/// Describes the bifurcation: persistence, nonsmooth fold, or neither (M. di Bernardo, C. Budd, A. Champneys and P.
/// Kowalczyk, "Piecewise-smooth Dynamical Systems", 2008, section 5.1).
std::string boundary_in_words(const Model& model, int own, const std::vector<MeetingEquilibrium>& others);

} // namespace graze
