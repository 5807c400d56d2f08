#pragma once

#include "graze/layout/wafer_yield.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// `graze layout DESIGN --yield N`: wafers of the design's devices, in a folder of tables and pictures.
/// @param wafer drawn by draw_wafer_layout
int layout_yield(const LayoutArguments& arguments, const DeviceFile& file, const Layout& wafer, const Console& console);

} // namespace graze
