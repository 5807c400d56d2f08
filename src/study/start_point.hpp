#pragma once

#include "graze/study/runner.hpp"

#include <string>
#include <vector>

namespace graze {

/// Where a run begins that starts from another one.
struct StartPoint {
    PointRecord point;              ///< state and mode
    std::vector<double> parameters; ///< all independent ones: of that point, except those that the run itself sets
};

/// The run of that name. @throws InputError when the study has none
const StudyRun& run_named(const Study& study, const std::string& name);

/// The point of an earlier run of kind orbit or continue that another one starts from.
/// @throws InputError when there is none
OrbitRecord orbit_to_start_from(const StartFrom& start, const StudyRun& parent, const ResultFile& file);

/// The point of an earlier run of any kind. @throws InputError when there is none, or no state to start from
StartPoint point_to_start_from(const StudyRun& run, const Study& study, const ResultFile& file);

/// Parameters of a point, those that a run itself sets replaced.
std::vector<double> with_own_parameters(const StudyRun& run, std::vector<double> parameters);
void set_parameters(Model& model, const std::vector<double>& values);

} // namespace graze
