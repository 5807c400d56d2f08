#include "picture/figure_look.hpp"

#include "picture/gnuplot_text.hpp"

#include <fmt/format.h>

#include <array>

namespace graze {

namespace {

constexpr double dots_per_inch = 200, points_per_inch = 72, svg_per_inch = 96;

/// The colours of Okabe and Ito (2008), which colour-blind readers can distinguish, with brown and grey instead of
/// yellow and black; then colours of Tol's muted scheme (2021) that differ from them.
constexpr std::array<std::uint32_t, 16> palette{0x0072b2, 0xd55e00, 0x009e73, 0xe69f00, 0xcc79a7, 0x56b4e9,
                                                0x7f4f24, 0x606060, 0x332288, 0x882255, 0x999933, 0x44aa99,
                                                0xcc3311, 0xaa4499, 0x117733, 0xbbaa66};
constexpr std::uint32_t light_grey = 0xb0b0b0;
constexpr std::array<std::uint32_t, 2> line_shades{0x000000, 0x808080};
constexpr std::array<std::uint32_t, 4> dot_shades{0x000000, 0x9a9a9a, 0x585858, 0xc4c4c4};
constexpr std::array<std::uint32_t, 4> cell_shades{0x585858, 0xd8d8d8, 0x8c8c8c, 0xb4b4b4};
constexpr std::array<int, 6> line_marks{5, 9, 7, 13, 11, 15}, circle_marks{6, 4, 8, 10, 12, 14}; // gnuplot's symbols

/// A darker shade, for colours beyond the end of the palette.
std::uint32_t darker(std::uint32_t colour, std::size_t times) {
    for (std::size_t i = 0; i < times; ++i)
        colour =
            (((colour >> 16) & 0xff) * 3 / 5) << 16 | (((colour >> 8) & 0xff) * 3 / 5) << 8 | (colour & 0xff) * 3 / 5;
    return colour;
}

/// A light tint, as of paper that is printed with little ink.
std::uint32_t tint_of(std::uint32_t colour) {
    constexpr double ink = 0.4;
    std::uint32_t tint = 0;
    for (const int shift : {16, 8, 0})
        tint |= static_cast<std::uint32_t>(0xff - ink * (0xff - ((colour >> shift) & 0xff)) + 0.5) << shift;
    return tint;
}

template <class Shades>
std::uint32_t shade_of(std::size_t colour, const Shades& shades) {
    if (colour == FigureSeries::grey)
        return light_grey;
    return colour == FigureSeries::black ? 0 : shades[colour % shades.size()];
}

} // namespace

std::uint32_t colour_number(std::size_t colour, bool grey) {
    if (colour >= FigureSeries::pale)
        return tint_of(colour_number(colour - FigureSeries::pale, grey));
    if (grey || colour >= FigureSeries::grey)
        return shade_of(colour, line_shades);
    return darker(palette[colour % palette.size()], colour / palette.size() % 3);
}

std::uint32_t dot_number(std::size_t colour, bool grey) {
    return grey ? shade_of(colour, dot_shades) : colour_number(colour);
}

std::uint32_t cell_number(std::size_t colour, bool grey) {
    if (colour >= FigureSeries::pale)
        return tint_of(cell_number(colour - FigureSeries::pale, grey));
    return grey ? shade_of(colour, cell_shades) : colour_number(colour);
}

std::string colour_text(std::size_t colour, bool grey) {
    return fmt::format("#{:06x}", colour_number(colour, grey));
}

int line_mark(std::size_t colour) {
    return colour == 0 || colour >= FigureSeries::grey ? 0 : line_marks[(colour - 1) % line_marks.size()];
}

int circle_mark(std::size_t colour) {
    return colour >= FigureSeries::grey ? 6 : circle_marks[colour % circle_marks.size()];
}

int cell_hatch(std::size_t colour) {
    if (colour >= FigureSeries::pale)
        return cell_hatch(colour - FigureSeries::pale);
    constexpr std::size_t solid = cell_shades.size();
    return colour < solid || colour >= FigureSeries::grey ? 0 : 1 + static_cast<int>((colour - solid) % 2);
}

bool is_line(FigureSeries::Style style) {
    using Style = FigureSeries::Style;
    return style == Style::line || style == Style::dashed || style == Style::dotted;
}

std::string FigureTerminal::text(const RichText& rich) const {
    return latex ? latex_markup(rich) : svg ? firm_blanks(gnuplot_markup(rich)) : gnuplot_markup(rich);
}

std::string FigureTerminal::font_text(double size) const {
    return fmt::format("font '{},{:.4g}'", font, size * letters);
}

FigureTerminal terminal_of(const FigureStyle& style, const FigureLayout& page, const std::string& ending) {
    FigureTerminal terminal;
    require_quotable(style.font);
    terminal.font = style.font.empty() ? "sans" : style.font;
    const double width = page.width / points_per_inch, height = page.height / points_per_inch;
    const double stroke = page.font / font_of_strokes; // line widths are proportional to the font size
    if (ending == "png") {
        terminal.pixels = true;
        const double scale = dots_per_inch / svg_per_inch;
        terminal.command =
            fmt::format("pngcairo noenhanced size {:.0f},{:.0f} fontscale {:.4g} linewidth {:.4g} pointscale {:.4g}",
                        width * dots_per_inch, height * dots_per_inch, scale, scale * stroke, scale);
    } else if (ending == "pdf" || ending == "eps") {
        terminal.point = 0.75;
        terminal.command = fmt::format("{}cairo enhanced size {:.4f}in,{:.4f}in fontscale 0.75 linewidth {:.4g}",
                                       ending, width, height, 1.5 * stroke);
    } else if (ending == "tex") {
        terminal.point = 0.75;
        terminal.latex = true;
        terminal.font = style.font;
        terminal.command =
            fmt::format("cairolatex pdf input size {:.4f}in,{:.4f}in linewidth {:.4g}", width, height, 1.5 * stroke);
    } else {
        terminal.svg = true;
        terminal.letters = svg_per_inch / points_per_inch;
        terminal.point = 7.2 / (page.font * terminal.letters);
        terminal.command = fmt::format("svg enhanced size {:.0f},{:.0f} linewidth {:.4g} background rgb 'white'",
                                       width * svg_per_inch, height * svg_per_inch, stroke);
    }
    terminal.command += ' ' + terminal.font_text(page.font);
    return terminal;
}

} // namespace graze
