#pragma once

#include "graze/branch/torus.hpp"

#include <optional>
#include <vector>

namespace graze {

/// Returns the resonance with the smallest denominator, up to 8, within a distance of a rotation number.
std::optional<Resonance> resonance_near(double rotation, double distance);
/// Returns the resonances with denominators up to 12 from one rotation number, which does not count, to another, in
/// this order.
std::vector<Resonance> resonances_between(double from, double to);

} // namespace graze
