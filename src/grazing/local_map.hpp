#pragma once

#include "graze/grazing/discontinuity_map.hpp"
#include "grazing/touch_geometry.hpp"

namespace graze {

/// The contacts for which a map is computed. Compliant contacts and next orders are expensive: they need second
/// derivatives of the vector fields.
enum class AskedContacts {
    all,
    rigid,
    rigid_beside, ///< rigid contacts; the touch may be slightly off the surface and is first projected onto it
};

/// Computes `discontinuity_map` with the touched function already compiled.
DiscontinuityMap local_map(const TouchFunctions& functions, const TouchState& touch, AskedContacts asked);

} // namespace graze
