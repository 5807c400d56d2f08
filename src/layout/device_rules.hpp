#pragma once

#include "graze/layout/device_drawing.hpp"

namespace graze {

/// Checks dimensions. @throws InputError for those that cannot be drawn, with the place of the one to change
void require_drawable(const DeviceDimensions& dimensions, const DeviceFile& file);

/// Checks that are only possible after drawing. @throws InputError
void require_well_drawn(const DeviceDrawing& drawing, const DeviceFile& file);

/// Returns the label on a die: its most important dimensions.
std::string label_of(const DeviceDimensions& dimensions);
/// Distance between the die's edge and its letters and marks. Nanometres.
std::int64_t edge_distance(const DeviceDimensions& dimensions);

} // namespace graze
