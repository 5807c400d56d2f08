#pragma once

#include "graze/layout/fabrication_rules.hpp"

#include <span>
#include <string>

namespace graze {

/// Places that break a rule as a report database of KLayout (.lyrdb), which its marker browser shows over the drawing:
/// a category for each broken rule, an item for each place, in the coordinates of its cell. Without broken rules it has
/// no items.
/// @param top cell that is drawn; @param generator who says so, as "graze 1.0"
std::string rule_markers(std::span<const RuleFinding> findings, const std::string& top, const std::string& generator);

} // namespace graze
