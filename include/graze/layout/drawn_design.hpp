#pragma once

#include "graze/design/design_report.hpp"
#include "graze/layout/matched_drawing.hpp"
#include "graze/model/parameter_file.hpp"
#include "graze/results/table.hpp"

#include <optional>
#include <string>

namespace graze {

/// A designed device, and the drawing that realises it.
struct DesignedDevice {
    Design own;   ///< design as in the file
    Model device; ///< model of the device that was found, at its trip value
    MatchedDrawing matched;
};

/// Comparison of a drawn device with the designed one.
struct DrawnDesign {
    /// Columns: quantity, designed, drawn, percent, unit, meaning; rows: numbers, trip value, class, time,
    /// requirements.
    Table table;
    bool met = true; ///< the drawing agrees with the design, and the device meets the requirements
};

/// Evaluates the drawn device as a design: its trip value, trip time and requirements.
/// @param results result file for the branch to the trip point, created if necessary
/// @return nothing when interrupted
/// @throws InputError as locate_trip and wishes_at do
std::optional<DrawnDesign> drawn_design(const DesignedDevice& designed, const std::string& results,
                                        const DesignReportOptions& options);

/// Returns the numbers of the drawing that were solved for, for its own file.
ParameterFile solved_numbers(const DesignedDevice& designed);
/// Returns the model parameters of the drawn device after the etch.
ParameterFile drawn_parameters(const DesignedDevice& designed);

} // namespace graze
