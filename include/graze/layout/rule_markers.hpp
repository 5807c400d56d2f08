#pragma once

#include "graze/layout/fabrication_rules.hpp"

#include <span>
#include <string>

namespace graze {

/// Returns the places that break a rule as a report database of KLayout (.lyrdb), which its marker browser shows over
/// the drawing: a category for each broken rule, an item for each place, in the coordinates of its cell. It has no
/// items if no rule is broken.
/// @param top top cell of the drawing; @param generator name of the program, such as "graze 1.0"
std::string rule_markers(std::span<const RuleFinding> findings, const std::string& top, const std::string& generator);

} // namespace graze
