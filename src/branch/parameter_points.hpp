#pragma once

#include "branch/point_kind.hpp"

namespace graze {

// Functions of extrema of periods and parameters, and of requested values of monitors: see PointRule.

PointRule::Test test_extremum, test_crossings;
PointRule::Confirm confirm_extremum, confirm_crossing;

} // namespace graze
