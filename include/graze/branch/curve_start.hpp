#pragma once

#include "graze/branch/special_point.hpp"

#include <string>
#include <vector>

namespace graze {

/// Returns the types of curves that pass through a point and can be followed: at a fold-flip `fold` and `flip`, at a
/// 1:1 resonance `fold` and `torus`, at a touch `grazing`. They are deduced from its multipliers, its event minima and
/// its own type.
std::vector<PointType> curves_at(const SpecialPoint& point);

/// Returns a point as one of another type whose curve passes through it: BranchSettings::kept for that curve. @throws
/// InputError when no such curve passes through it, saying which do
SpecialPoint as_type(const SpecialPoint& point, PointType type);

/// Returns a description of a point for messages: its multipliers, or that they are not defined.
std::string multipliers_in_words(const SpecialPoint& point);

} // namespace graze
