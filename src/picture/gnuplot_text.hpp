#pragma once

#include <string>

namespace graze {

// All text that comes from a model, study, result file or command line and goes to gnuplot goes through here. Gnuplot
// can run a shell: what cannot be quoted is refused.

/// A line that ends within quotes ends a command, and what stands on the next one is obeyed.
/// @throws InputError for control characters
void require_quotable(const std::string& text);
/// For double quotes: what gnuplot's enhanced text would take for markup, and what it would have a shell run, is taken
/// as it stands. @throws InputError for control characters
std::string plain(const std::string& text);
/// A path between single quotes. @throws InputError for control characters
std::string quoted_path(const std::string& path);
/// A unit such as m/s^2, with raised exponents.
std::string unit_text(const std::string& unit);
/// A name such as x_nd or q1 as a symbol with an index; longer names are words, and expressions stay as they are.
std::string name_text(const std::string& name);
/// A label with its unit in parentheses.
std::string with_unit(const std::string& label, const std::string& unit);
/// Markup in which viewers of SVG keep the blanks beside changes of the letters.
std::string firm_blanks(std::string markup);
std::string number_text(double value);

} // namespace graze
