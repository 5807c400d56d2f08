#pragma once

#include "graze/branch/yield.hpp"
#include "graze/design/design.hpp"

namespace graze {

/// Returns the tolerances of a design for a device with this orbit, and the limits of usable trip values. Without
/// tolerances all devices are equal.
YieldSettings yield_settings_of(const Design& design, const Orbit& orbit);

} // namespace graze
