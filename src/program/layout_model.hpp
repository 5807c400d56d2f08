#pragma once

#include "graze/layout/fabrication_rules.hpp"
#include "program/program.hpp"

#include <string>

namespace graze {

/// Writes the parameters of the etched device for `--set @FILE` of other commands.
void write_device_parameters(const DeviceFile& file, const DrawnDevice& device, const std::string& path);

/// Writes the etched device as a module of Verilog-A. @throws InputError for models that it cannot express
void write_verilog_a(const DeviceFile& file, const DrawnDevice& device, const std::string& path);

/// True when all fabrication rules hold. @param markers file for the places that break one; empty: no file
/// @param despite only print broken rules. @throws InputError for a broken rule otherwise
bool check_rules(const DeviceFile& file, const Layout& layout, bool despite, const std::string& markers,
                 const Console& console);

} // namespace graze
