#pragma once

#include "graze/layout/fabrication_rules.hpp"
#include "program/program.hpp"

#include <string>

namespace graze {

/// Writes the parameters of the device for other commands' `--set @FILE`.
void write_device_parameters(const DeviceFile& file, const DrawnDevice& device, const std::string& path);

/// Writes the device as a module of Verilog-A. @throws InputError when its model has not what that takes
void write_verilog_a(const DeviceFile& file, const DrawnDevice& device, const std::string& path);

/// Whether all rules hold. @param markers file for the places that break one; empty: none
/// @throws InputError unless that is to be told alone
bool check_rules(const DeviceFile& file, const Layout& layout, bool despite, const std::string& markers,
                 const Console& console);

} // namespace graze
