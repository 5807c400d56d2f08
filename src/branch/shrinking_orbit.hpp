#pragma once

#include "branch/branch_state.hpp"
#include "branch/hopf_point.hpp"
#include "orbit/cut.hpp"

#include <optional>

namespace graze {

/// True when the scaled rates at the first start have reversed between two orbits of the branch. Between nearby points
/// this happens where the orbits shrink to an equilibrium: the solutions of the equations continue through it, with the
/// same orbits half a period later.
bool has_reversed(BranchState& state, const Orbit& before, const Orbit& now);

/// Locates the equilibrium to which the orbits of the last step shrink, from points at a distance on both sides: the
/// equations are singular there, since an equilibrium is an orbit of any period.
/// @return empty if the orbits do not shrink
std::optional<SpecialPoint> locate_equilibrium(BranchState& state, const Orbit& before);

/// Computes the Hopf point ahead on a branch of orbits without contacts, after a step in which a section or cut was
/// touched, from the equations of the equilibrium, which do not involve sections.
/// @param from start of that step; @param length of that step
/// @return empty where no such equilibrium exists, or it lies much farther away than the length of the step
std::optional<HopfPoint> hopf_ahead(BranchState& state, const ContinuationPoint& from, double length);

/// Returns an orbit of the current problem that rests at a Hopf point.
Orbit at_rest_in(const Orbit& orbit, const HopfPoint& hopf, ParameterId parameter);

/// Returns an orbit that starts where it is farthest from the Hopf point and ends at a cut whose plane contains that
/// point, so that all smaller orbits cross it, and the direction in which the orbits shrink.
/// @return empty where the orbit cannot be followed
std::optional<UncutOrbit> begun_for_shrinking(BranchState& state, const Orbit& orbit, const HopfPoint& hopf);

/// True when the parameter approaches that of the Hopf point with the square of the orbit's size.
bool shrinks_to(const HopfPoint& hopf, ParameterId parameter, const Orbit& before, const Orbit& now);

/// Returns the end of the branch at the Hopf point. @param arclength of the current point; @param distance from it
std::optional<SpecialPoint> end_in(BranchState& state, const HopfPoint& hopf, double arclength, double distance);

/// Returns the arclength between an orbit of the current problem and the orbit at rest.
double distance_to(BranchState& state, const ContinuationPoint& from, const HopfPoint& hopf);

} // namespace graze
