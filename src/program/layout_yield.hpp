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

/// One row for each device. @param control, unit of the trip value; @param model in whose units the parameters are
Table wafer_device_table(const WaferYield& yield, const Model& model, const std::string& control);

/// The statistics: quantity, value, unit, meaning.
Table wafer_fact_table(const WaferYield& yield, const Model& model, const std::string& control, std::size_t wafers);

} // namespace graze
