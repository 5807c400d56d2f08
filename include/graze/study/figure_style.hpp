#pragma once

#include <string>

namespace graze {

/// Size of a picture on paper, and its font.
struct FigureStyle {
    double width = 0, height = 0; ///< in mm; 0: the usual width, and the height that fits the panels
    double font_size = 0;         ///< in points; 0: chosen by the width
    std::string font;             ///< its name; empty: one without serifs
    bool grey = false;            ///< shades of grey, and symbols along lines, instead of colours
};

} // namespace graze
