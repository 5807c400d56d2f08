#pragma once

#include "graze/layout/grid_polygon.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace graze {

constexpr std::int64_t letter_columns = 5, letter_rows = 7; ///< size of a letter, in squares

/// Whether a text consists of available characters: letters of English (small ones drawn as capitals), digits, blanks
/// and . , - + = / _ : ( ).
bool can_be_drawn(std::string_view text);

/// Width of a text for a height of letters. Nanometres.
std::int64_t letters_width(std::string_view text, std::int64_t height);

/// Returns the letters of a text as boxes for a mask, which do not overlap and touch along edges only. The lower left
/// corner of the first one is the origin. @param height nanometres, rounded down to a multiple of seven
std::vector<GridBox> letter_boxes(std::string_view text, std::int64_t height);

} // namespace graze
