#pragma once

#include "graze/layout/device_drawing.hpp"

namespace graze {

/// What a model of a device needs, measured from its outlines. Micrometres and square micrometres.
struct DeviceMeasures {
    double gap = 0;           ///< between the fixed electrode and the mass
    double facing_length = 0; ///< of their faces
    double stop_gap = 0;      ///< between the mass and the nearer stop
    double stop_length = 0;   ///< of the faces of both stops
    double mass_area = 0;     ///< of the H with its lugs
    double truss_area = 0;    ///< of all trusses, of which not all move like the mass
    double beam_area = 0;     ///< of all beams
    double beam_width = 0, beam_length = 0;
    double beam_spacing = 0; ///< between neighbours
    std::size_t beams = 0;   ///< of both flexures
    double electrode_area = 0, base_area = 0;
    double etched_area = 0;  ///< of mask 2, notches included, without letters and marks
    double chamber_area = 0; ///< of mask 1, without marks
};
DeviceMeasures measures_of(const DeviceDrawing& drawing);

} // namespace graze
