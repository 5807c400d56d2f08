#pragma once

#include "graze/atlas/atlas_findings.hpp"
#include "graze/results/table.hpp"
#include "graze/study/study.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// The run of kind atlas that has made a run of a study; null: the study itself asks for the run.
const StudyRun* atlas_that_made(const Study& study, const std::string& run);

/// The types of a point in words: "fold and grazing".
std::string words_of(const AtlasPoint& point);

/// The tables of what an atlas has found: "curves", "points", "branches", "motions", and "left", which is what it has
/// not gone on from.
std::vector<std::string> atlas_table_names();

/// One of these tables, with every number and text. A list within a cell is separated by "; ".
/// @throws InputError for another name
Table atlas_table(const AtlasFindings& findings, std::string_view name);

/// Every curve, then every point, in one table: what a row has no number for is missing.
Table curves_and_points(const AtlasFindings& findings);

} // namespace graze
