#pragma once

#include "graze/layout/fabrication_rules.hpp"
#include "graze/results/table.hpp"
#include "program/program.hpp"

#include <string>

namespace graze {

/// Adds rows with the lumped model of a device: cell, what, value, unit.
void add_lumped_rows(Table& table, const DeviceFile& file, const DrawnDevice& device);

/// Writes the parameters of the device for other commands' `--set @FILE`.
void write_device_parameters(const DeviceFile& file, const DrawnDevice& device, const std::string& path);

/// Whether all rules hold. @throws InputError unless that is to be told alone
bool check_rules(const DeviceFile& file, const Layout& layout, bool despite, const Console& console);

} // namespace graze
