#pragma once

#include "graze/layout/wafer_yield.hpp"
#include "graze/results/table.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

#include <string>

namespace graze {

/// `graze layout DESIGN --yield N`: wafers of the design's devices, in a folder of tables and pictures.
/// @param wafer drawn by draw_wafer_layout
int layout_yield(const LayoutArguments& arguments, const DeviceFile& file, const Layout& wafer, const Console& console);

/// One row for each device, with the dimensions that were drawn at its site in the last columns.
/// @param wafer that was drawn; @param model in whose units the parameters are; @param control whose value trips it
Table wafer_device_table(const WaferYield& yield, const Layout& wafer, const Model& model, const std::string& control);

/// The statistics: quantity, value, unit, meaning.
Table wafer_fact_table(const WaferYield& yield, const Model& model, const std::string& control, std::size_t wafers);

} // namespace graze
