#pragma once

#include "graze/layout/process_steps.hpp"

#include <string>
#include <vector>

namespace graze {

/// Commands for gnuplot that draw cross-sections of a device after each step of the process.
/// @param ending svg, png or pdf; @param output the file that the commands write
std::string fabrication_picture_script(const std::vector<ProcessStep>& steps, const std::string& ending,
                                       const std::string& output);

} // namespace graze
