#pragma once

#include "graze/layout/device_file.hpp"

#include <string>

namespace graze {

/// How a design is made, step by step, with the numbers that it uses: a bonded stack of two wafers and two masks, after
/// B. E. Wilcox, "On the use of impact-induced nonlinearities in limit switch design", section 6.3 and appendix D.
/// Markdown.
std::string recipe_text(const DeviceFile& file);

} // namespace graze
