#pragma once

#include "graze/layout/layout.hpp"

#include <optional>
#include <string>

namespace graze {

/// Commands for gnuplot that draw the device with labels of its parts, or the wafer, and both masks below.
/// @param ending svg, png or pdf; @param output the file that the commands write
/// @param mask 1 or 2: only this mask, seen from the front; none: everything
std::string layout_picture_script(const Layout& layout, const std::string& ending, const std::string& output,
                                  std::optional<int> mask = std::nullopt);

} // namespace graze
