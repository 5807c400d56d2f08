#include "graze/layout/mask_letters.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace graze {

namespace {

struct Glyph {
    char letter;
    std::array<const char*, letter_rows> rows; ///< rows from the top
};

/// Squares that touch at a corner always share a neighbour: touching at a corner alone would not form a valid polygon.
constexpr Glyph glyphs[] = {
    {' ', {"     ", "     ", "     ", "     ", "     ", "     ", "     "}},
    {'0', {"#####", "#   #", "#   #", "#   #", "#   #", "#   #", "#####"}},
    {'1', {" ##  ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", "#####"}},
    {'2', {"#####", "    #", "    #", "#####", "#    ", "#    ", "#####"}},
    {'3', {"#####", "    #", "    #", " ####", "    #", "    #", "#####"}},
    {'4', {"#   #", "#   #", "#   #", "#####", "    #", "    #", "    #"}},
    {'5', {"#####", "#    ", "#    ", "#####", "    #", "    #", "#####"}},
    {'6', {"#####", "#    ", "#    ", "#####", "#   #", "#   #", "#####"}},
    {'7', {"#####", "    #", "    #", "   ##", "   # ", "   # ", "   # "}},
    {'8', {"#####", "#   #", "#   #", "#####", "#   #", "#   #", "#####"}},
    {'9', {"#####", "#   #", "#   #", "#####", "    #", "    #", "#####"}},
    {'A', {" ### ", "## ##", "#   #", "#####", "#   #", "#   #", "#   #"}},
    {'B', {"#### ", "#  # ", "#  # ", "#####", "#   #", "#   #", "#####"}},
    {'C', {"#####", "#    ", "#    ", "#    ", "#    ", "#    ", "#####"}},
    {'D', {"#### ", "#  ##", "#   #", "#   #", "#   #", "#  ##", "#### "}},
    {'E', {"#####", "#    ", "#    ", "#### ", "#    ", "#    ", "#####"}},
    {'F', {"#####", "#    ", "#    ", "#### ", "#    ", "#    ", "#    "}},
    {'G', {"#####", "#    ", "#    ", "#  ##", "#   #", "#   #", "#####"}},
    {'H', {"#   #", "#   #", "#   #", "#####", "#   #", "#   #", "#   #"}},
    {'I', {" ### ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", " ### "}},
    {'J', {"  ###", "    #", "    #", "    #", "#   #", "#   #", "#####"}},
    {'K', {"#  ##", "#  # ", "# ## ", "###  ", "# ## ", "#  # ", "#  ##"}},
    {'L', {"#    ", "#    ", "#    ", "#    ", "#    ", "#    ", "#####"}},
    {'M', {"## ##", "#####", "# # #", "# # #", "#   #", "#   #", "#   #"}},
    {'N', {"##  #", "##  #", "### #", "# # #", "# ###", "#  ##", "#  ##"}},
    {'O', {" ### ", "## ##", "#   #", "#   #", "#   #", "## ##", " ### "}},
    {'P', {"#####", "#   #", "#   #", "#####", "#    ", "#    ", "#    "}},
    {'Q', {"#####", "#   #", "#   #", "#   #", "# # #", "# ###", "#####"}},
    {'R', {"#### ", "#  ##", "#  ##", "#### ", "# ## ", "#  ##", "#   #"}},
    {'S', {" ####", "##   ", "#    ", "#####", "    #", "   ##", "#### "}},
    {'T', {"#####", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  "}},
    {'U', {"#   #", "#   #", "#   #", "#   #", "#   #", "#   #", "#####"}},
    {'V', {"#   #", "#   #", "#   #", "## ##", " # # ", " ### ", "  #  "}},
    {'W', {"#   #", "#   #", "#   #", "# # #", "# # #", "#####", "## ##"}},
    {'X', {"#   #", "## ##", " ### ", "  #  ", " ### ", "## ##", "#   #"}},
    {'Y', {"#   #", "## ##", " ### ", "  #  ", "  #  ", "  #  ", "  #  "}},
    {'Z', {"#####", "    #", "   ##", "  ## ", " ##  ", "##   ", "#####"}},
    {'.', {"     ", "     ", "     ", "     ", "     ", " ##  ", " ##  "}},
    {',', {"     ", "     ", "     ", "     ", " ##  ", " ##  ", " #   "}},
    {'-', {"     ", "     ", "     ", "#####", "     ", "     ", "     "}},
    {'_', {"     ", "     ", "     ", "     ", "     ", "     ", "#####"}},
    {'+', {"     ", "  #  ", "  #  ", "#####", "  #  ", "  #  ", "     "}},
    {'=', {"     ", "     ", "#####", "     ", "#####", "     ", "     "}},
    {':', {"     ", " ##  ", " ##  ", "     ", " ##  ", " ##  ", "     "}},
    {'/', {"    #", "   ##", "   # ", "  ## ", " ##  ", " #   ", "##   "}},
    {'(', {"  ## ", " ##  ", " #   ", " #   ", " #   ", " ##  ", "  ## "}},
    {')', {" ##  ", "  ## ", "   # ", "   # ", "   # ", "  ## ", " ##  "}},
};

const Glyph* glyph_of(char letter) {
    const char capital = letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
    const Glyph* found =
        std::find_if(std::begin(glyphs), std::end(glyphs), [&](const Glyph& glyph) { return glyph.letter == capital; });
    return found == std::end(glyphs) ? nullptr : found;
}

/// One box per square: all corners on an edge are ends of an edge, so that no crack opens when letters are rotated and
/// their corners are rounded.
void add_glyph(const Glyph& glyph, std::int64_t left, std::int64_t square, std::vector<GridBox>& boxes) {
    for (std::int64_t row = 0; row < letter_rows; ++row) {
        const std::string_view squares = glyph.rows[static_cast<std::size_t>(row)];
        const std::int64_t top = (letter_rows - row) * square;
        for (std::int64_t column = 0; column < letter_columns; ++column)
            if (squares[static_cast<std::size_t>(column)] == '#') {
                const std::int64_t from = left + column * square;
                boxes.push_back({from, top - square, from + square, top});
            }
    }
}

} // namespace

bool can_be_drawn(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char letter) { return glyph_of(letter) != nullptr; });
}

std::int64_t letters_width(std::string_view text, std::int64_t height) {
    const auto letters = static_cast<std::int64_t>(text.size());
    return text.empty() ? 0 : (letters * (letter_columns + 1) - 1) * (height / letter_rows);
}

std::vector<GridBox> letter_boxes(std::string_view text, std::int64_t height) {
    std::vector<GridBox> boxes;
    const std::int64_t square = height / letter_rows;
    std::int64_t left = 0;
    for (const char letter : text) {
        if (const Glyph* glyph = glyph_of(letter); glyph && square > 0)
            add_glyph(*glyph, left, square, boxes);
        left += (letter_columns + 1) * square;
    }
    return boxes;
}

} // namespace graze
