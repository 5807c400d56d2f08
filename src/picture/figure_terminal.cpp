#include "picture/figure_terminal.hpp"

#include "picture/gnuplot_text.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

constexpr double dots_per_inch = 200, points_per_inch = 72, svg_per_inch = 96;

} // namespace

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
