#pragma once

#include "graze/branch/yield.hpp"
#include "graze/results/located_point.hpp"
#include "graze/results/table.hpp"

#include <string>

namespace graze {

/// Reads NAME=SIZE, NAME=SIZE% (a percentage of the parameter's value at the point) or NAME=SIZE:uniform.
/// @param option in which it is written, for messages
/// @throws InputError for other texts, for a size below zero, and for the parameter whose value follows from the others
Tolerance read_tolerance(const LocatedPoint& point, const std::string& text, const std::string& option);

/// Sets the limits of acceptable values by LOW:HIGH, of which one side may be left out.
/// @throws InputError for other texts
void read_interval(YieldSettings& settings, const LocatedPoint& point, const std::string& text,
                   const std::string& option);

/// Derivatives by all other parameters. @param yield adds columns for the tolerances and what each contributes; may be
/// null, as `settings` then
Table derivative_table(const LocatedPoint& point, const YieldSettings* settings, const Yield* yield);

/// Statistics of a yield: a row for each, with the columns `quantity`, `value`, `low`, `high` (of the confidence
/// interval) and `meaning`. @param name of the value
Table yield_table(const Yield& yield, const std::string& name);

} // namespace graze
