#pragma once

#include "graze/layout/device_file.hpp"

#include <string>
#include <vector>

namespace graze {

/// Returns the fabrication recipe of a design, step by step with its numbers, in Markdown: a bonded stack of two wafers
/// and two masks, after B. E. Wilcox, "On the use of impact-induced nonlinearities in limit switch design", section 6.3
/// and appendix D.
/// @param options of `graze layout` after the design, such as "--set" and "gap=14", with which it was read: the
/// commands for the masks repeat them
std::string recipe_text(const DeviceFile& file, const std::vector<std::string>& options = {});

} // namespace graze
