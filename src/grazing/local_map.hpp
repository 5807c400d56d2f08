#pragma once

#include "graze/grazing/discontinuity_map.hpp"
#include "grazing/touch_geometry.hpp"

namespace graze {

/// What is asked of a contact. Compliant ones and next orders take a while, since second derivatives of the fields are
/// needed.
enum class AskedContacts {
    all,
    rigid,
    rigid_beside, ///< a touch may be off the surface a little, and is put there first by the least step
};

/// As `discontinuity_map`, with the touched function compiled already.
DiscontinuityMap local_map(const TouchFunctions& functions, const TouchState& touch, AskedContacts asked);

} // namespace graze
