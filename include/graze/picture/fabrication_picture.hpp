#pragma once

#include "graze/layout/process_steps.hpp"

#include <string>
#include <vector>

namespace graze {

/// Cross-sections after each step in which a device is made, in gnuplot's language.
/// @param ending svg, png or pdf
std::string fabrication_picture_script(const std::vector<ProcessStep>& steps, const std::string& ending,
                                       const std::string& output);

} // namespace graze
