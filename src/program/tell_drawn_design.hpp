#pragma once

#include "graze/layout/drawn_design.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

#include <string>

namespace graze {

/// Reads the device of a design's folder, and solves for the drawing.
/// @throws InputError when there is none in the folder, or one of another model
DesignedDevice matched_device(const DeviceFile& file, const std::string& design, const std::string& folder);

/// Gives what is drawn back to the design: where it trips, how fast, and what it has of what is wanted, beside what was
/// designed. Prints it, and leaves in the folder: the table (drawn.csv), the numbers of the drawing (drawing.toml) and
/// the parameters of the model (drawn.toml), both for `--set @FILE`, and the way to the trip point (drawn.sqlite).
/// @return whether the device is as designed, and has what is wanted; otherwise the exit code says so
int tell_drawn_design(const DesignedDevice& designed, const std::string& folder, const LayoutArguments& arguments,
                      const Console& console);

} // namespace graze
