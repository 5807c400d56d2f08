#pragma once

#include "graze/layout/layout.hpp"

#include <string>

namespace graze {

/// Adds the cells of a device, the last of which is the device itself. @param ending suffix of their names
void add_device_cells(LayoutLibrary& library, const DeviceDrawing& drawing, const std::string& ending);

/// Adds letters on a layer. @param at lower left corner; @param mirrored for the back, within the same box
void add_letters(LayoutCell& cell, MaskLayer layer, const std::string& text, GridPoint at, std::int64_t height,
                 bool mirrored = false);

} // namespace graze
