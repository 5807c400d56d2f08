#pragma once

#include "graze/layout/device_file.hpp"
#include "graze/model/model.hpp"

#include <string>
#include <vector>

namespace graze {

/// A number of a design's model, and the number of the drawing or its process by which a drawn device has it.
struct MatchedQuantity {
    std::string parameter, unit;    ///< of the model
    double designed = 0, drawn = 0; ///< in that unit; `drawn` after the etch
    std::string number;             ///< of the design file, as "device.gap" or "process.pressure"
    std::string number_unit;
    double before = 0, after = 0; ///< that number, as the file has it and as it was solved for
    bool met = false;             ///< no step of the grid brings it nearer
    std::string reason;           ///< why not met

    double relative() const; ///< departure of what is drawn from what is designed, by the latter
};

struct MatchedDrawing {
    DeviceFile file; ///< with the numbers that were solved for
    std::vector<MatchedQuantity> quantities;

    bool is_met() const;
};

/// Solves for the numbers of a drawing whose device has, after the etch, what a design's model has: gap and stop gap
/// for d and stop, the electrode's length for the area, the bars' width for the mass, the beams' length for the natural
/// frequency, and the pressure of the gas for the damping ratio, up to an atmosphere. Lengths stay on the grid. Each
/// number alone moves its quantity one way only, and they are solved for in turn, again and again until none moves.
/// What was given on the command line (DeviceFile::place) stays as it is.
/// @param designed with the parameters m, f0, zeta, area, d and stop
/// @throws InputError where the device of the file itself cannot be drawn, or the model lacks a parameter
MatchedDrawing match_drawing(const DeviceFile& file, const Model& designed);

} // namespace graze
