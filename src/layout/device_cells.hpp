#pragma once

#include "graze/layout/layout.hpp"

#include <string>

namespace graze {

/// Adds the cells of a device, the last of which is it. @param ending of their names
void add_device_cells(LayoutLibrary& library, const DeviceDrawing& drawing, const std::string& ending);

/// Adds letters on a layer. @param at their lower left corner; @param mirrored for the back, in their own place
void add_letters(LayoutCell& cell, MaskLayer layer, const std::string& text, GridPoint at, std::int64_t height,
                 bool mirrored = false);

} // namespace graze
