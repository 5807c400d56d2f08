#pragma once

#include "graze/design/design.hpp"

#include <string>

namespace graze {

/// The device as a model, in the folder of a design.
constexpr const char* device_model_name = "device.toml";
/// A file that is in the folder of a design from the beginning of the work on it to its end: as long as it is there,
/// other files are none of that design, or not all.
constexpr const char* unfinished_name = "design-unfinished.txt";

/// What that file says.
std::string unfinished_text(const Design& design);
/// The first line of `device.toml`, a comment by which it is known whose device it is.
std::string device_heading(const Design& design);
/// @param place where the folder was named
/// @throws InputError where the folder has no device, one of a design whose work has not come to its end, or one of
/// another design; of a device without a heading nobody can tell
void require_device_of(const Design& design, const std::string& folder, const Place& place);

} // namespace graze
