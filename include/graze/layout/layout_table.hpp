#pragma once

#include "graze/layout/device_file.hpp"
#include "graze/layout/layout.hpp"
#include "graze/results/table.hpp"

namespace graze {

/// Returns what is measured on a drawing, with the columns cell, what, value, unit: lengths and areas of each distinct
/// device, its lumped model, the directions of the devices of a wafer, and the area of each layer.
Table layout_table(const Layout& layout, const DeviceFile& file);

} // namespace graze
