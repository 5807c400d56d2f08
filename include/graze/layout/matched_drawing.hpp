#pragma once

#include "graze/layout/device_file.hpp"
#include "graze/model/model.hpp"

#include <string>
#include <vector>

namespace graze {

/// A parameter of a design's model, and the number of the drawing or its process that determines it in a drawn device.
struct MatchedQuantity {
    std::string parameter, unit;    ///< parameter of the model, and its unit
    double designed = 0, drawn = 0; ///< values in that unit; `drawn` is after the etch
    std::string number;             ///< key of the design file, such as "device.gap"
    std::string number_unit;
    double before = 0, after = 0; ///< that number in the file, and as solved for
    bool met = false;             ///< no step of the grid brings it closer
    std::string reason;           ///< why not met

    /// Relative deviation of the drawn from the designed value.
    double relative() const { return drawn / designed - 1; }
};

struct MatchedDrawing {
    DeviceFile file; ///< file with the numbers that were solved for
    std::vector<MatchedQuantity> quantities;

    bool is_met() const;
};

/// Solves for the numbers of a drawing whose device has, after the etch, the parameters of a design's model: gap and
/// stop gap for d and stop, the electrode's length for the area, the bars' width for the mass, the beams' length for
/// the natural frequency, and the gas pressure, up to an atmosphere, for the damping ratio. Lengths stay on the grid.
/// Each parameter is monotonic in its number; they are solved for in turn, repeatedly, until none changes. Numbers
/// given on the command line (DeviceFile::place) stay fixed.
/// @param designed model with the parameters m, f0, zeta, area, d and stop
/// @throws InputError when the file's own device cannot be drawn, or the model lacks a parameter
MatchedDrawing match_drawing(const DeviceFile& file, const Model& designed);

} // namespace graze
