#pragma once

#include "graze/results/orbit_record.hpp"
#include "graze/study/study.hpp"

#include <optional>

namespace graze {

/// What becomes of an orbit beyond its touch, by the map of its cycle and the first of the run's parameters that moves
/// the orbit from the touch. It is told of grazings, and of all points of curves of touches. @return none otherwise
std::optional<TouchFindings> findings_at(const StudyRun& run, const SpecialPoint& point);

} // namespace graze
