#pragma once

#include "picture/figure_layout.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace graze {

constexpr double font_of_strokes = 9; ///< font size in points to which line widths refer

/// Settings of a terminal of gnuplot, which depend on the format of the file.
struct FigureTerminal {
    std::string command; ///< arguments of `set terminal`
    double point = 1;    ///< gnuplot's `pointsize` of a symbol with a diameter of 4.5 points
    double letters = 1;  ///< gnuplot's font size for one point
    std::string font;    ///< name of the font
    bool latex = false;  ///< the file is text for LaTeX
    bool pixels = false; ///< the file has pixels (png)
    bool svg = false;

    std::string text(const RichText& rich) const;
    std::string font_text(double size) const;
};

/// Settings for a format. @param ending svg, png, pdf, eps or tex
/// @throws InputError for a font name that cannot be quoted for gnuplot
FigureTerminal terminal_of(const FigureStyle& style, const FigureLayout& page, const std::string& ending);

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
/// True for lines with or without gaps.
bool is_line(FigureSeries::Style style);

} // namespace graze
