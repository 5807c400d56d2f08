#pragma once

#include "orbit/orbit_equations.hpp"

#include <span>
#include <string>

namespace graze {

/// A periodic orbit does not depend on the section at which its segments end, as long as the motion crosses the
/// section. Where the motion only touches it, the branch of the equations has a spurious fold. There a cut, a plane
/// laid across the motion itself, replaces the section.

/// Returns for each segment the rate at which the motion crosses the section that ends it, divided by the typical rate;
/// for a cut only the direction of crossing, 1 or -1; 1 for events.
std::vector<double> passing_rates(const OrbitEquations& equations, const OrbitEvaluation& at);
/// Returns the first segment whose section the motion crosses so slowly that it nearly only touches it; empty if there
/// is none.
std::optional<std::size_t> touched_section(const std::vector<double>& rates);
/// Returns the first segment whose section or cut is now crossed in the opposite direction: in between, the motion
/// touched it.
std::optional<std::size_t> reversed_section(const std::vector<double>& before, const std::vector<double>& rates);
/// True when the motion has turned so far from the normal of a cut that the plane should be laid anew.
bool cuts_are_oblique(const OrbitEquations& equations, const OrbitEvaluation& at);

/// An orbit and a direction of change, without sections: without contacts, cuts replace the sections; with contacts,
/// segments are merged up to the next contact.
struct UncutOrbit {
    Orbit orbit;
    OrbitDirection direction;
};
/// Removes the sections of an orbit. @return empty where that is impossible, as for a half orbit with contacts that a
/// section ends, and for homoclinic orbits
std::optional<UncutOrbit> without_sections(const Model& model, const Orbit& orbit, const OrbitDirection& direction);

/// Divides an orbit without contacts into segments between passages of one of the model's sections: a phase section if
/// there is one, since a phase crosses it at the same rate however the orbit changes; otherwise the preferred section,
/// or else the first that the orbit crosses. Empty if it crosses none.
/// @param state on the orbit; @param duration after which the state (or its image under the symmetry) returns
/// @param symmetry of a half orbit, which becomes a single segment
std::optional<Orbit> close_at_section(const System& system, const std::vector<double>& parameters,
                                      std::span<const double> state, std::size_t mode, double duration,
                                      const std::string& preferred, std::optional<std::size_t> symmetry);

/// Divides a smooth orbit in one mode, given by consecutive arcs with arbitrary ends, into segments between passages of
/// a section. The first segment begins with the first arc. Events that the orbit only touches are ignored.
Orbit cut_at_section(const System& system, const Orbit& arcs, std::size_t section);

} // namespace graze
