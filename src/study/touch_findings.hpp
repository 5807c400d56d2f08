#pragma once

#include "graze/results/orbit_record.hpp"
#include "graze/study/study.hpp"

#include <optional>

namespace graze {

/// What becomes of an orbit beyond its touch, by the map of its cycle and the first of the run's parameters that moves
/// it from there: of grazings, and of all points of curves that touch. @return none where nothing is touched
std::optional<TouchFindings> findings_at(const StudyRun& run, const SpecialPoint& point);

} // namespace graze
