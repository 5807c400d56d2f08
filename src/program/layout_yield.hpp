#pragma once

#include "graze/layout/wafer_yield.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// Carries out `graze layout DESIGN --yield N`: simulates wafers of devices and writes a folder of tables and maps.
/// @param wafer drawn by draw_wafer_layout
int layout_yield(const LayoutArguments& arguments, const DeviceFile& file, const Layout& wafer, const Console& console);

} // namespace graze
