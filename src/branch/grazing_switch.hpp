#pragma once

#include "graze/branch/switching.hpp"

namespace graze {

/// Returns the start of the branch on which a touch has become a contact of small speed.
/// @throws InputError when the motion after such a contact does not return to it
BranchStart with_one_more_contact(const System& system, const SpecialPoint& point, const BranchSettings& settings);
/// Returns a touching orbit as an orbit with a contact of zero speed, at the same parameters.
/// @throws InputError as above
Orbit with_contact_of_no_speed(const System& system, const SpecialPoint& point, const BranchSettings& settings);
/// Returns the start of the branch without a contact whose speed has vanished.
BranchStart with_one_contact_fewer(const System& system, const SpecialPoint& point, const BranchSettings& settings);

} // namespace graze
