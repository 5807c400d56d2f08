#pragma once

#include "graze/study/study.hpp"

#include <cstddef>

namespace graze {

/// The row of a point in a run of motions: the points of a sweep along its first axis, in both directions, make a row,
/// and each point of another run. A row is a chain if states are carried along it.
std::size_t row_of(const StudyRun& run, std::size_t point);

} // namespace graze
