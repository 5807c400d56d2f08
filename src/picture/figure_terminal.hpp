#pragma once

#include "picture/figure_layout.hpp"

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

} // namespace graze
