#pragma once

#include "picture/figure_layout.hpp"

#include <string>

namespace graze {

constexpr double font_of_strokes = 9; ///< points: for which the widths of lines are given

/// What differs between the kinds of files that gnuplot draws.
struct FigureTerminal {
    std::string command;
    double point = 1;   ///< gnuplot's size of a symbol with a diameter of 4.5 points
    double letters = 1; ///< the font's size, for a point
    std::string font;   ///< its name
    bool latex = false;
    bool pixels = false;
    bool svg = false;

    std::string text(const RichText& rich) const;
    std::string font_text(double size) const;
};

/// @param ending svg, png, pdf, eps or tex @throws InputError for a font's name that gnuplot cannot be told
FigureTerminal terminal_of(const FigureStyle& style, const FigureLayout& page, const std::string& ending);

} // namespace graze
