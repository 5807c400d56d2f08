#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/orbit/solve.hpp"
#include "graze/trajectory/simulation.hpp"

#include <optional>
#include <vector>

namespace graze {

/// A grazing orbit whose touch has become a contact: it begins after the contact with what the model does until it is
/// back in the mode in which it was touching (nothing, if the contact does not leave that mode; a stretch in contact or
/// slipping otherwise), goes on with the segments of the grazing orbit, and ends with the contact. Sections that ended
/// segments are not needed any more. None if the motion does not come back soon enough.
/// @param after, mode just after the contact; @param last the segment that the contact ends
std::optional<Orbit> with_contact_inserted(const Simulation& simulation, const SpecialPoint& point,
                                           const std::vector<double>& after, std::size_t mode, const Segment& last);

/// The contacts of a motion that has been followed for one round and begins between two of them, as an orbit that
/// begins after the first. @param like has the parameters and the symmetry
Orbit begun_after_first_contact(const System& system, const Orbit& like, const FollowedMotion& motion, double round);

} // namespace graze
