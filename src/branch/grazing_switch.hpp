#pragma once

#include "graze/branch/switching.hpp"

namespace graze {

/// The orbit in which a touch has become a contact of small speed.
/// @throws InputError when the model's motion after such a contact does not come back to it
BranchStart with_one_more_contact(const System& system, const SpecialPoint& point, const BranchSettings& settings);
/// A touching orbit as one whose contact has no speed, at the same parameters.
/// @throws InputError as above
Orbit with_contact_of_no_speed(const System& system, const SpecialPoint& point, const BranchSettings& settings);
/// The orbit without a contact that has lost its speed.
BranchStart with_one_contact_fewer(const System& system, const SpecialPoint& point, const BranchSettings& settings);

} // namespace graze
