#pragma once

#include "graze/layout/grid_polygon.hpp"

#include <string_view>
#include <vector>

namespace graze {

constexpr std::int64_t letter_columns = 5, letter_rows = 7; ///< of squares, of which a letter is made

/// Whether the letters of a text can all be drawn: letters of English, small ones drawn as capitals, digits, blanks
/// and . , - + = / _ : ( ).
bool can_be_drawn(std::string_view text);

/// Of a text with letters of a height. Nanometres.
std::int64_t letters_width(std::string_view text, std::int64_t height);

/// Letters as boxes that do not overlap and touch along edges only, for a mask. The first one's lower left corner is
/// the origin. @param height nanometres, of which whole sevenths are used
std::vector<GridBox> letter_boxes(std::string_view text, std::int64_t height);

} // namespace graze
