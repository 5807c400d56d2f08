#pragma once

#include <string>

namespace graze {

// All text from models, studies, result files and the command line that goes to gnuplot is quoted by these functions.
// gnuplot can run a shell: text that cannot be quoted is refused.

/// Checks that a text can be quoted: a line feed within quotes would end the command, and gnuplot would run the next
/// line.
/// @throws InputError for control characters
void require_quotable(const std::string& text);
/// Escapes a text for double quotes, so that gnuplot prints it unchanged, neither as markup of enhanced text nor as a
/// command for a shell. @throws InputError for control characters
std::string plain(const std::string& text);
/// A path in single quotes. @throws InputError for control characters
std::string quoted_path(const std::string& path);
/// Replaces blanks at changes of the font, which SVG viewers would drop, by blanks that they keep.
std::string firm_blanks(std::string markup);
/// Arguments of `set terminal` without the font, for a drawing on a page in pixels. @param ending svg, png or pdf
/// @param png_scale number of dots of a PNG for each pixel
std::string drawing_terminal(const std::string& ending, double width, double height, double png_scale = 1);

} // namespace graze
