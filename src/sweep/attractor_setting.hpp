#pragma once

#include "graze/sweep/point_search.hpp"
#include "sweep/field_map.hpp"
#include "sweep/sample_recorder.hpp"
#include "sweep/step_maps.hpp"

namespace graze {

/// Data shared by all searches of a run.
struct AttractorSetting {
    AttractorSetting(const System& system, const AttractorOptions& given, const std::vector<Sampling>& samplings,
                     const std::vector<Expression>& values, const SimulationOptions& simulation_options);

    AttractorOptions options;
    SampleRecorder::Layout layout;
    Simulation simulation;
    SectionMap map;
    FieldMap field;
    VariationalModes variational;
    Function image; ///< image under the first symmetry, in states and parameters
    std::vector<std::size_t> image_modes;
};

} // namespace graze
