#pragma once

#include "branch/branch_state.hpp"
#include "branch/hopf_point.hpp"
#include "orbit/cut.hpp"

#include <optional>

namespace graze {

/// Whether the motion at an orbit's first start has turned round since another orbit of the branch: its rates there,
/// in units of the scales. Between two points close to one another it does so where the orbits shrink to an
/// equilibrium: the equations lead through that, and back along the same orbits, half a period later.
bool has_turned_round(BranchState& state, const Orbit& before, const Orbit& now);

/// The equilibrium to which the orbits of the last step shrink, from points at a distance on both sides: the equations
/// cannot be solved there, since an equilibrium is an orbit of any period.
/// @return none if the orbits do not shrink there
std::optional<SpecialPoint> locate_equilibrium(BranchState& state, const Orbit& before);

/// The Hopf point that lies ahead on a branch whose last step, from an orbit without contacts, has led past where a
/// section or a cut is only touched: by the equilibrium's own equations, which know nothing of sections.
/// @param from where that step began; @param length of it
/// @return none where there is no such equilibrium, or it lies much farther than the step has gone
std::optional<HopfPoint> hopf_ahead(BranchState& state, const ContinuationPoint& from, double length);

/// An orbit, of the problem at hand, at rest in a Hopf point.
Orbit at_rest_in(const Orbit& orbit, const HopfPoint& hopf, ParameterId parameter);

/// The same orbit, begun where it is farthest from the Hopf point, and closed by a cut: whose plane leads through that
/// point, so that smaller and smaller orbits cross it. With the direction in which they shrink.
/// @return none where the orbit cannot be followed
std::optional<UncutOrbit> begun_for_shrinking(BranchState& state, const Orbit& orbit, const HopfPoint& hopf);

/// Whether the way from one orbit to a smaller one is that to the Hopf point: with the square of the size.
bool shrinks_to(const HopfPoint& hopf, ParameterId parameter, const Orbit& before, const Orbit& now);

/// The end of the branch there. @param arclength of the point at which the problem is; @param way from it
std::optional<SpecialPoint> end_in(BranchState& state, const HopfPoint& hopf, double arclength, double way);

/// Distance between an orbit of the problem at hand and where it is at rest, as lengths of steps are measured.
double way_to(BranchState& state, const ContinuationPoint& from, const HopfPoint& hopf);

} // namespace graze
