#pragma once

#include "graze/model/drawing.hpp"
#include "graze/model/microbeam.hpp"

#include <functional>

namespace graze {

/// Returns the drawing of a microbeam: its deflected shape between electrode and stop, deflections enlarged.
/// @param shape of a mode (from 1) at a place on the beam
ModelDrawing microbeam_drawing(const MicrobeamOptions& options, const std::function<double(int, double)>& shape);

} // namespace graze
