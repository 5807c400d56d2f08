#pragma once

#include "graze/layout/device_drawing.hpp"

namespace graze {

/// @throws InputError for dimensions of which no device can be drawn, with the place of the one that is to be changed
void require_drawable(const DeviceDimensions& dimensions, const DeviceFile& file);

/// What cannot be told before a device is drawn. @throws InputError
void require_well_drawn(const DeviceDrawing& drawing, const DeviceFile& file);

/// The letters that a die bears: its most important dimensions.
std::string label_of(const DeviceDimensions& dimensions);
/// Between the die's edge and its letters and marks. Nanometres.
std::int64_t edge_distance(const DeviceDimensions& dimensions);

/// Nanometres.
std::int64_t nanometres(double micrometres);

} // namespace graze
