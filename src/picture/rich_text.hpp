#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// A piece of text in one style.
struct TextRun {
    enum class Look { upright, italic, lowered, raised };
    std::string text;
    Look look = Look::upright;
};

/// A line of formatted text, independent of the drawing program: names with indices, units with raised exponents.
using RichText = std::vector<TextRun>;

/// The text without formatting.
RichText rich(const std::string& text);
/// A name such as x_nd or q1 as a symbol with an index; longer names become words, other texts stay unchanged.
RichText rich_name(const std::string& name);
/// A text in which names from `symbols` are symbols: those with an index, and others if "=", "up" or "down" follows.
RichText rich_words(const std::string& text, const std::vector<std::string>& symbols);
/// A unit such as m/s^2, with raised exponents.
RichText rich_unit(const std::string& unit);
/// The power of ten with this exponent.
RichText rich_power(int exponent);
RichText operator+(RichText one, const RichText& other);
/// The text without formatting.
std::string letters_of(const RichText& text);

/// Width of a text in units of the font size, for DejaVu Sans, which is wider than other common fonts.
double width_of(const RichText& text);
/// Breaks a text at blanks, but not beside "=" or after "Fig.". Words that are too long are cut.
/// @param width of lines in units of the font size; @param most number of lines; further lines are left out
std::vector<std::string> wrapped_lines(const std::string& text, double width, std::size_t most);

/// Markup of gnuplot's enhanced text, for double quotes. @throws InputError for control characters
std::string gnuplot_markup(const RichText& text);
/// Markup for LaTeX, for double quotes in gnuplot. No character of the text is taken as a command.
/// @throws InputError for control characters
std::string latex_markup(const RichText& text);

} // namespace graze
