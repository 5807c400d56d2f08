#pragma once

#include "graze/atlas/atlas_findings.hpp"
#include "program/table.hpp"

#include <string>

namespace graze {

/// What an atlas has found, how much of it motions confirm, and what it has not gone on from, in some lines for people.
std::string summary_text(const AtlasFindings& findings);
/// The same numbers, for a program.
void add_summary(JsonObject& heading, const AtlasFindings& findings);
/// Whether something contradicts what the branches predict: a motion on an orbit within the limits that none of them
/// has, or stable orbits on which no motion settles.
bool has_contradiction(const AtlasFindings& findings);

} // namespace graze
