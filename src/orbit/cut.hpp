#pragma once

#include "graze/orbit/orbit.hpp"
#include "orbit/orbit_equations.hpp"

#include <optional>
#include <vector>

namespace graze {

/// A periodic orbit does not depend on where it is cut. Sections say so as long as the motion crosses them: where it
/// only touches one, equations that are made with the section turn back although the orbits go on. A cut, a plane laid
/// across the motion itself, takes the place of the section there.

/// The rates at which the motion passes the sections that end segments, in units of usual ones; of a cut only the way
/// it is passed, 1 or -1; 1 for other ends.
std::vector<double> passing_rates(const OrbitEquations& equations, const OrbitEvaluation& at);
/// The segment whose section the motion passes so slowly that it is about to touch it only.
std::optional<std::size_t> touched_section(const std::vector<double>& rates);
/// The segment whose section or cut is passed the other way than before: in between it has been touched.
std::optional<std::size_t> turned_section(const std::vector<double>& before, const std::vector<double>& rates);
/// Whether the motion has turned so far from the normal of a cut that the plane is to be laid anew.
bool cuts_are_oblique(const OrbitEquations& equations, const OrbitEvaluation& at);

/// The same orbit without its sections, with a direction of it: without contacts it ends its segments by cuts; with
/// contacts they go on to these. None where that is impossible, as of a half orbit with contacts that a section ends.
struct UncutOrbit {
    Orbit orbit;
    OrbitDirection direction;
};
std::optional<UncutOrbit> without_sections(const Model& model, const Orbit& orbit, const OrbitDirection& direction);

} // namespace graze
