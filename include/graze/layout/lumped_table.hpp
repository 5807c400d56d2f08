#pragma once

#include "graze/layout/device_file.hpp"
#include "graze/layout/layout.hpp"
#include "graze/results/table.hpp"

namespace graze {

/// Adds rows with the lumped model of a device: cell, what, value, unit.
void add_lumped_rows(Table& table, const DeviceFile& file, const DrawnDevice& device);

} // namespace graze
