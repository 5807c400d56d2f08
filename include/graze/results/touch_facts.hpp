#pragma once

#include "graze/grazing/trial.hpp"
#include "graze/results/table.hpp"
#include "graze/results/touching_orbit.hpp"

namespace graze {

/// What is known of a touching orbit and of what becomes of it: a row for each number or word, with the columns
/// `quantity`, `value` and `meaning`. Numbers that do not apply have no row.
Table touch_facts(const TouchingOrbit& orbit, const TouchReport& report);

} // namespace graze
