#pragma once

#include "graze/design/design.hpp"

#include <string>

namespace graze {

/// File name of the device's model in the folder of a design.
constexpr const char* device_model_name = "device.toml";
/// Name of a file that is in the folder of a design while the design is being computed: as long as it exists, the other
/// files belong to an earlier run or are incomplete.
constexpr const char* unfinished_name = "design-unfinished.txt";

/// Returns the content of that file.
std::string unfinished_text(const Design& design);
/// Returns the first line of `device.toml`, a comment that identifies the design.
std::string device_heading(const Design& design);
/// Checks that a folder holds the device of a design.
/// @param place where the folder was named
/// @throws InputError when the folder has no device, that of an unfinished run, or that of another design; a device
/// without a heading is accepted
void require_device_of(const Design& design, const std::string& folder, const Place& place);

} // namespace graze
