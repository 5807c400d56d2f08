#pragma once

#include "graze/layout/device_drawing.hpp"
#include "graze/layout/device_file.hpp"
#include "graze/layout/layout_cell.hpp"

#include <string>
#include <vector>

namespace graze {

struct DrawnDevice {
    std::string cell;
    DeviceDrawing drawing;
};

/// A drawing in cells: FLEXURE within DEVICE, and that within SITE and WAFER if there is a wafer.
struct Layout {
    LayoutLibrary library;
    std::string top;                  ///< all, seen from the front
    std::vector<DrawnDevice> devices; ///< that differ
    std::vector<std::size_t> sites;   ///< of the wafer: which device each has, counterclockwise
    std::vector<double> site_degrees; ///< into which direction each one's channel points, from the x axis
};

/// The device of a design file; docs/layout.md tells cells and layers.
/// @throws InputError for dimensions of which nothing can be drawn
Layout draw_device_layout(const DeviceFile& file);

/// Its wafer. The first device points half a pitch from the x axis (a quarter where they are odd in number), on which
/// the wafer's marks are. @throws InputError also for devices that overlap or reach out of what can be used
Layout draw_wafer_layout(const DeviceFile& file);

/// Adds cells that have nothing but what is on one mask, with the top cells MASK_1 and MASK_2. Mask 1 is mirrored from
/// x to -x, as the wafer's back is seen.
void add_masks(Layout& layout);
/// The cells of one of them alone. @param mask 1 or 2
LayoutLibrary mask_library(const Layout& layout, int mask);

} // namespace graze
