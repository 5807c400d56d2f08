#pragma once

#include "graze/orbit/solve.hpp"
#include "graze/results/orbit_motion.hpp"
#include "graze/results/quantity_evaluator.hpp"
#include "graze/results/table.hpp"

#include <vector>

namespace graze {

/// The motion along an orbit: a row for each time. @param model at the orbit's parameters
Table orbit_table(const Model& model, const std::vector<SegmentMotion>& motion,
                  const std::vector<NamedValue>& quantities);

// What certifies that the model would follow an orbit (Certificate). Segments are counted from 1.

/// A row for each segment: how its event is met at its end.
Table segment_table(const Model& model, const OrbitSolution& solution);
/// The minima of event functions inside segments: how close other events come.
Table minimum_table(const Model& model, const OrbitSolution& solution);
/// Values of other event functions at the ends of segments.
Table end_value_table(const Model& model, const OrbitSolution& solution);

} // namespace graze
