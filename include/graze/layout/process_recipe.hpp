#pragma once

#include "graze/layout/device_file.hpp"

#include <string>
#include <vector>

namespace graze {

/// How a design is made, step by step, with the numbers that it uses: a bonded stack of two wafers and two masks, after
/// B. E. Wilcox, "On the use of impact-induced nonlinearities in limit switch design", section 6.3 and appendix D.
/// Markdown.
/// @param options of `graze layout` behind the design, such as "--set" and "gap=14", with which it was read: the
/// commands for the masks repeat them
std::string recipe_text(const DeviceFile& file, const std::vector<std::string>& options = {});

} // namespace graze
