#pragma once

#include "graze/layout/device_drawing.hpp"
#include "graze/layout/device_file.hpp"
#include "graze/layout/layout_cell.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// A device of a layout: its cell and its outlines.
struct DrawnDevice {
    std::string cell;
    DeviceDrawing drawing;
};

/// A drawing as a hierarchy of cells: FLEXURE within DEVICE, within SITE and WAFER if there is a wafer.
struct Layout {
    LayoutLibrary library;
    std::string top;                  ///< top cell, seen from the front
    std::vector<DrawnDevice> devices; ///< distinct devices
    std::vector<std::size_t> sites;   ///< sites of the wafer: index of the device of each, counterclockwise
    std::vector<double> site_degrees; ///< direction of each site's channel, in degrees from the x axis
};

/// Draws the device of a design file; docs/layout.md lists cells and layers.
/// @throws InputError for dimensions that cannot be drawn
Layout draw_device_layout(const DeviceFile& file);

/// Draws the wafer of a design file. The first device points half a pitch from the x axis (a quarter for odd numbers),
/// since the wafer's marks lie on that axis. @throws InputError also for devices that overlap or leave the usable area
Layout draw_wafer_layout(const DeviceFile& file);

/// Adds the cells of each mask alone, with the top cells MASK_1 and MASK_2. Mask 1 is mirrored from x to -x, as the
/// wafer's back is seen.
void add_masks(Layout& layout);
/// Returns the cells of one mask alone. @param mask 1 or 2
LayoutLibrary mask_library(const Layout& layout, int mask);

} // namespace graze
