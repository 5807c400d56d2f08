#pragma once

#include "graze/layout/device_drawing.hpp"

#include <cstddef>

namespace graze {

/// Measures of a device's outlines that its lumped model needs, in micrometres and square micrometres.
struct DeviceMeasures {
    double gap = 0;           ///< gap between the fixed electrode and the mass
    double facing_length = 0; ///< length over which their faces oppose each other
    double stop_gap = 0;      ///< gap between the mass and the nearer stop
    double stop_length = 0;   ///< length of the faces of both stops
    double mass_area = 0;     ///< area of the H with its lugs
    double truss_area = 0;    ///< area of all trusses, which move by different shares of the mass's displacement
    double beam_area = 0;     ///< area of all beams
    double beam_width = 0, beam_length = 0;
    double beam_spacing = 0; ///< between neighbouring beams
    std::size_t beams = 0;   ///< number of beams of both flexures
    double electrode_area = 0, base_area = 0;
    double etched_area = 0;  ///< etched area of mask 2, including notches, without letters and marks
    double chamber_area = 0; ///< etched area of mask 1, without marks
};
/// Measures a drawing.
DeviceMeasures measures_of(const DeviceDrawing& drawing);

} // namespace graze
