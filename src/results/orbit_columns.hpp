#pragma once

#include "results/columns.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// A run of kind orbit or continue, and its model, whose names the rows contain.
struct OrbitContext {
    OrbitContext(const RunRecord& of_run, const Model& of_model);

    const RunRecord* run;
    const Model* model;
    std::vector<ParameterId> parameters; ///< parameters that are coordinates of the run
};

/// Columns of a table of orbits.
const ColumnsOf<OrbitContext, OrbitRecord>& orbit_columns();

/// One segment of an orbit.
struct SegmentRow {
    std::size_t point = 0, number = 0; ///< number of the orbit, and of the segment in the orbit, which begins at 1
    std::string mode, ending;
    double duration = 0, approach_speed = 0, departure = 0, guard_margin = 0;
    std::vector<double> start;
};
/// Columns of a table of segments.
const ColumnsOf<OrbitContext, SegmentRow>& segment_columns();

/// Columns of detail tables, after run, point and position. An unknown event is read as the number of events.
const ColumnsOf<OrbitContext, OrbitMinimum>& minimum_columns();
const ColumnsOf<OrbitContext, EndValue>& end_value_columns();
/// An unknown state is read as the number of states.
const ColumnsOf<OrbitContext, CircleTerm>& circle_columns();

} // namespace graze
