#pragma once

#include "graze/layout/drawn_design.hpp"
#include "graze/layout/fabrication_rules.hpp"
#include "graze/layout/wafer_yield.hpp"
#include "graze/study/workers.hpp"
#include "program/arguments.hpp"
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

/// Carries out `graze layout DESIGN --yield N`: simulates wafers of devices and writes a folder of tables and maps.
/// @param wafer drawn by draw_wafer_layout
/// @param workers solve for the devices; null: threads of this process do
int layout_yield(const LayoutArguments& arguments, const DeviceFile& file, const Layout& wafer, const Console& console,
                 Workers* workers);

/// Reads the designed device from the output folder of `graze design`, and solves for the drawing that gives it.
/// @throws InputError when the folder has no device, or one of another model
DesignedDevice matched_device(const DeviceFile& file, const std::string& design, const std::string& folder);

/// Computes where and how fast the drawn device trips and which wishes it meets, and compares it with the designed one.
/// Prints the table and writes into the folder: the table (drawn.csv), the numbers of the drawing (drawing.toml) and
/// the parameters of the model (drawn.toml), both for `--set @FILE`, and the branch to the trip point (drawn.sqlite).
/// @return exit_success if the drawn device is as designed and meets the wishes
int report_drawn_design(const DesignedDevice& designed, const std::string& folder, const LayoutArguments& arguments,
                        const Console& console);

} // namespace graze
