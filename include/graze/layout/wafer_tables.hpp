#pragma once

#include "graze/layout/wafer_yield.hpp"
#include "graze/results/table.hpp"

#include <cstddef>
#include <string>

namespace graze {

/// Returns one row for each device, with the drawn dimensions of its site in the last columns.
/// @param wafer drawn wafer; @param model gives the units of parameters; @param control parameter whose value trips the
/// device
Table wafer_device_table(const WaferYield& yield, const Layout& wafer, const Model& model, const std::string& control);

/// Returns the statistics with the columns quantity, value, unit, meaning.
Table wafer_fact_table(const WaferYield& yield, const Model& model, const std::string& control, std::size_t wafers);

/// Returns the report of a yield as JSON, from these two tables. @param design its name; @param version of graze
std::string wafer_report_json(const std::string& design, const WaferYieldSettings& settings, const Table& facts,
                              const Table& devices, const std::string& version);

} // namespace graze
