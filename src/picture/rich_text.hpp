#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// Letters of one look.
struct TextRun {
    enum class Look { upright, italic, lowered, raised };
    std::string text;
    Look look = Look::upright;
};

/// A line of text as it is to be seen, whoever draws it: names with their indices, units with raised exponents.
using RichText = std::vector<TextRun>;

/// As it stands.
RichText rich(const std::string& text);
/// A name such as x_nd or q1 as a symbol with an index; longer names are words, and what is no name stays as it is.
RichText rich_name(const std::string& name);
/// A text in which some names are set as symbols: those with an index, and others where "=", "up" or "down" follows.
RichText rich_words(const std::string& text, const std::vector<std::string>& symbols);
/// A unit such as m/s^2, with raised exponents.
RichText rich_unit(const std::string& unit);
/// A power of ten.
RichText rich_power(int exponent);
RichText operator+(RichText one, const RichText& other);
std::string letters_of(const RichText& text);

/// How wide a text is, in sizes of its font: that of DejaVu Sans, which is wider than other common fonts.
double width_of(const RichText& text);
/// Lines of no more than so many sizes of the font, broken at blanks, but not beside "=" and behind "Fig.". Words that
/// are too long are cut short; lines beyond the most are left out.
std::vector<std::string> wrapped_lines(const std::string& text, double width, std::size_t most);

/// For double quotes in gnuplot, as its own enhanced text. @throws InputError for control characters
std::string gnuplot_markup(const RichText& text);
/// For double quotes in gnuplot, when LaTeX sets the text. No letter of it can be a command.
std::string latex_markup(const RichText& text);

} // namespace graze
