#pragma once

#include "results/columns.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// A run of kind orbit or continue, in whose model's words its rows are written.
struct OrbitContext {
    OrbitContext(const RunRecord& of_run, const Model& of_model);

    const RunRecord* run;
    const Model* model;
    std::vector<ParameterId> parameters; ///< of the run's columns
};

/// Of a table of orbits.
const ColumnsOf<OrbitContext, OrbitRecord>& orbit_columns();

/// One segment of an orbit.
struct SegmentRow {
    std::size_t point = 0, number = 0; ///< of the orbit; of the segment in it, from 1 on
    std::string mode, ending;
    double duration = 0, approach_speed = 0, departure = 0, guard_margin = 0;
    std::vector<double> start;
};
/// Of a table of segments.
const ColumnsOf<OrbitContext, SegmentRow>& segment_columns();

/// Of tables of details, behind run, point and position. An event that the model does not have is read as their number.
const ColumnsOf<OrbitContext, OrbitMinimum>& minimum_columns();
const ColumnsOf<OrbitContext, EndValue>& end_value_columns();

} // namespace graze
