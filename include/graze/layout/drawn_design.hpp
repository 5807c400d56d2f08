#pragma once

#include "graze/design/design_report.hpp"
#include "graze/layout/matched_drawing.hpp"
#include "graze/model/parameter_file.hpp"
#include "graze/results/table.hpp"

#include <optional>
#include <string>

namespace graze {

/// What a design has found, and the drawing that gives it.
struct DesignedDevice {
    Design own;   ///< as the file has it
    Model device; ///< that was found, at its trip value
    MatchedDrawing matched;
};

/// What a drawn device is beside what was designed.
struct DrawnDesign {
    Table table;     ///< quantity, designed, drawn, percent, unit, meaning: numbers, trip value, class, time, wishes
    bool met = true; ///< the drawing is as designed, and the device has what is wanted
};

/// Gives what is drawn back to the design: where it trips, how fast, and what it has of what is wanted.
/// @param results file for the way to the trip point, made if need be
/// @return none when interrupted
/// @throws InputError as locate_trip and wishes_at do
std::optional<DrawnDesign> drawn_design(const DesignedDevice& designed, const std::string& results,
                                        const DesignReportOptions& options);

/// The numbers of the drawing that were solved for, for the drawing's own file.
ParameterFile solved_numbers(const DesignedDevice& designed);
/// The parameters of the model that the drawn device has, after the etch.
ParameterFile drawn_parameters(const DesignedDevice& designed);

} // namespace graze
