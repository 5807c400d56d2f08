#pragma once

#include "graze/branch/special_point.hpp"

#include <string>
#include <vector>

namespace graze {

/// What curves begin at a point: types of points that it is, which can be kept. At a fold-flip `fold` and `flip`, at a
/// 1:1 resonance `fold` and `torus`, at a touch `grazing`. By its multipliers, its least values and its own type.
std::vector<PointType> curves_at(const SpecialPoint& point);

/// A point as one of another type, whose curve passes through it: BranchSettings::kept for that curve.
/// @throws InputError when it is none, saying what it has and what can be asked
SpecialPoint as_type(const SpecialPoint& point, PointType type);

/// What a point has, for people: its multipliers, or that they are not defined.
std::string multipliers_in_words(const SpecialPoint& point);

} // namespace graze
