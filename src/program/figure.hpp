#pragma once

#include "graze/study/figure.hpp"

#include <string>
#include <vector>

namespace graze {

/// A figure in the language of gnuplot, data included.
/// @param ending svg, png, pdf, eps or tex; @param output the file that the commands write
std::string figure_script(const Figure& figure, const std::string& ending, const std::string& output);

/// Endings of the files that can be drawn.
std::vector<std::string> figure_endings();

/// Draws with gnuplot. What ends in .tex is text for LaTeX, with the lines in a file beside it that ends in .pdf.
/// @param data_path where to keep the commands as well; may be empty
/// @throws InputError when gnuplot is missing or fails, or a file cannot be written
void draw_figure(const Figure& figure, const std::string& path, const std::string& data_path);

} // namespace graze
