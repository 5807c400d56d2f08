#pragma once

#include <string>

namespace graze {

/// How large a picture is on paper, and its letters.
struct FigureStyle {
    double width = 0, height = 0; ///< in mm; 0: as usual, and as high as fits
    double font_size = 0;         ///< in points; 0: by the width
    std::string font;             ///< its name; empty: without serifs
    bool grey = false;            ///< without colours: shades, and symbols along the lines
};

} // namespace graze
