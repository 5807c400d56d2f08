#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace graze {

// Translation of the colour index of a series into colours or, for grey pictures, into shades and symbols.

/// The colour as 0xrrggbb. The first 48 colours differ. Shades of grey repeat, and `line_mark`, `circle_mark` and
/// `cell_hatch` distinguish them.
std::uint32_t colour_number(std::size_t colour, bool grey = false);
/// The colour as gnuplot reads it, such as "#0072b2".
std::string colour_text(std::size_t colour, bool grey = false);
/// The colour of dots, which are too small for different symbols: in grey pictures four shades.
std::uint32_t dot_number(std::size_t colour, bool grey);
/// The colour of filled areas; grey shades are light enough to see symbols on them.
std::uint32_t cell_number(std::size_t colour, bool grey);

/// In grey pictures: gnuplot's symbol that marks lines of a colour; 0: none.
int line_mark(std::size_t colour);
/// In grey pictures: gnuplot's symbol that replaces circles of a colour.
int circle_mark(std::size_t colour);
/// In grey pictures: gnuplot's pattern that fills cells of a colour; 0: solid.
int cell_hatch(std::size_t colour);

} // namespace graze
