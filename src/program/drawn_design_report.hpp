#pragma once

#include "graze/layout/drawn_design.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

#include <string>

namespace graze {

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
