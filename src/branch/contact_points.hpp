#pragma once

#include "branch/point_kind.hpp"

namespace graze {

// Functions of points at which contacts appear or disappear or events change their order: see PointRule.

PointRule::Test test_grazing, test_vanishing, test_two_events, test_guard, test_sensitivity, test_acceleration;
PointRule::Confirm confirm_grazing, confirm_double_grazing, confirm_vanishing, confirm_two_events, confirm_guard,
    confirm_sensitivity, confirm_degenerate_grazing, confirm_acceleration;
PointRule::Rank rank_of_grazing;
PointRule::Condition condition_of_grazing, condition_of_vanishing, condition_of_two_events, condition_of_guard;
PointRule::Leave leave_grazing, leave_double_grazing, leave_order;

} // namespace graze
