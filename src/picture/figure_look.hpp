#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace graze {

// What an index of a series' colour is on paper, with colours or without.

/// As 0xrrggbb. No two of the first 48 are the same in colour. In grey shades repeat: `line_mark`, `circle_mark` and
/// `cell_hatch` then tell them apart.
std::uint32_t colour_number(std::size_t colour, bool grey = false);
/// The same as gnuplot reads it, such as "#0072b2".
std::string colour_text(std::size_t colour, bool grey = false);
/// Shades of dots, which are too small to have a shape.
std::uint32_t dot_number(std::size_t colour, bool grey);
/// Shades of areas, which are not to hide what lies on them.
std::uint32_t cell_number(std::size_t colour, bool grey);

/// In pictures without colours: which of gnuplot's symbols stands along lines of a colour; 0: none.
int line_mark(std::size_t colour);
/// And which stands for circles of it.
int circle_mark(std::size_t colour);
/// And which of gnuplot's patterns fills cells of it; 0: the shade alone.
int cell_hatch(std::size_t colour);

} // namespace graze
