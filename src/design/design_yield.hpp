#pragma once

#include "graze/branch/yield.hpp"
#include "graze/design/design.hpp"

namespace graze {

/// How the devices of a design differ from one with this orbit, and which of them will do: what is wanted of them, or
/// of the trip value. Without tolerances none differ.
YieldSettings yield_settings_of(const Design& design, const Orbit& orbit);

} // namespace graze
