#pragma once

#include "graze/layout/wafer_yield.hpp"
#include "graze/results/table.hpp"

#include <cstddef>
#include <string>

namespace graze {

/// One row for each device, with the dimensions that were drawn at its site in the last columns.
/// @param wafer that was drawn; @param model in whose units the parameters are; @param control whose value trips it
Table wafer_device_table(const WaferYield& yield, const Layout& wafer, const Model& model, const std::string& control);

/// The statistics: quantity, value, unit, meaning.
Table wafer_fact_table(const WaferYield& yield, const Model& model, const std::string& control, std::size_t wafers);

} // namespace graze
