#pragma once

#include "graze/picture/figure.hpp"

#include <string>
#include <vector>

namespace graze {

/// Commands for gnuplot that draw a figure, with the data.
/// @param ending svg, png, pdf, eps or tex; @param output the file that the commands write
std::string figure_script(const Figure& figure, const std::string& ending, const std::string& output);

/// Endings of file names for which figures can be drawn.
std::vector<std::string> figure_endings();

} // namespace graze
