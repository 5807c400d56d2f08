#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/orbit/solve.hpp"
#include "graze/trajectory/simulation.hpp"

#include <optional>
#include <vector>

namespace graze {

/// Appends a segment to an orbit.
inline void append(Orbit& orbit, const Segment& segment, const std::vector<double>& start, double duration) {
    orbit.signature.push_back(segment);
    orbit.starts.push_back(start);
    orbit.durations.push_back(duration);
}

/// Returns a grazing orbit with its touch replaced by a contact. The orbit begins after the contact, with the motion in
/// other modes until the return to the touching mode (if the contact leaves it), continues with the segments of the
/// grazing orbit, and ends with the contact. Segments that ended at sections are merged. Empty if the motion does not
/// return soon enough.
/// @param after, mode state and mode just after the contact; @param last the segment that the contact ends
std::optional<Orbit> with_contact_inserted(const Simulation& simulation, const SpecialPoint& point,
                                           const std::vector<double>& after, std::size_t mode, const Segment& last);

/// Returns a motion that was followed for one period, starting between two contacts, as an orbit that begins after the
/// first contact. @param like orbit with the parameters and the symmetry; @param period of the motion
Orbit begun_after_first_contact(const System& system, const Orbit& like, const FollowedMotion& motion, double period);

} // namespace graze
