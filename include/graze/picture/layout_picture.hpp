#pragma once

#include "graze/layout/layout.hpp"

#include <optional>
#include <string>

namespace graze {

/// The device with its parts named, or the wafer, and both masks below, in gnuplot's language.
/// @param ending svg, png or pdf; @param output the file that the commands write
/// @param mask 1 or 2: this one alone, seen from the front, fills the page; none: as above
std::string layout_picture_script(const Layout& layout, const std::string& ending, const std::string& output,
                                  std::optional<int> mask = std::nullopt);

} // namespace graze
