#include "program/figure.hpp"

#include "graze/symbolic/input_error.hpp"
#include "program/covered_lines.hpp"
#include "program/curve.hpp"
#include "program/dot_strokes.hpp"
#include "program/figure_layout.hpp"
#include "program/gnuplot_text.hpp"
#include "program/mingled_crosses.hpp"
#include "program/mingled_dots.hpp"
#include "program/output_file.hpp"
#include "program/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <utility>

namespace graze {

namespace {

constexpr double dots_per_inch = 200, points_per_inch = 72, svg_per_inch = 96;
constexpr double usual_font = 9;      ///< points: for which the widths of lines are given
constexpr double dash_of_cairo = 1.6; ///< for dashes as long as those of legends
/// By how much of a panel's size a line may be moved.
constexpr double unseen = 1e-4;
/// That of Okabe and Ito (2008), whose colours the colour-blind tell apart too; brown and grey in the place of yellow
/// and black.
constexpr std::array<std::uint32_t, 8> palette{0x0072b2, 0xd55e00, 0x009e73, 0xe69f00,
                                               0xcc79a7, 0x56b4e9, 0x7f4f24, 0x606060};
constexpr std::uint32_t light_grey = 0xb0b0b0;

std::uint32_t colour_number(std::size_t colour) {
    if (colour == FigureSeries::grey)
        return light_grey;
    return colour == FigureSeries::black ? 0 : palette[colour % palette.size()];
}

/// What differs between the kinds of files.
struct Terminal {
    std::string command;
    double point = 1;   ///< gnuplot's size of a symbol with a diameter of 4.5 points
    double letters = 1; ///< the font's size, for a point
    std::string font;   ///< its name
    bool latex = false;
    bool pixels = false;
    bool svg = false;

    std::string text(const RichText& rich) const {
        return latex ? latex_markup(rich) : svg ? firm_blanks(gnuplot_markup(rich)) : gnuplot_markup(rich);
    }
    std::string font_text(double size) const { return fmt::format("font '{},{:.4g}'", font, size * letters); }
};

Terminal terminal_of(const Figure& figure, const FigureLayout& page, const std::string& ending) {
    Terminal terminal;
    require_quotable(figure.style.font);
    terminal.font = figure.style.font.empty() ? "sans" : figure.style.font;
    const double width = page.width / points_per_inch, height = page.height / points_per_inch;
    const double stroke = page.font / usual_font; // lines become thicker as letters become larger
    if (ending == "png") {
        terminal.pixels = true;
        const double scale = dots_per_inch / svg_per_inch;
        terminal.command = fmt::format(
            "pngcairo noenhanced size {:.0f},{:.0f} fontscale {:.4g} linewidth {:.4g} pointscale {:.4g} "
            "dashlength {:.4g}",
            width * dots_per_inch, height * dots_per_inch, scale, scale * stroke, scale, dash_of_cairo * stroke);
    } else if (ending == "pdf") {
        terminal.point = 0.75;
        terminal.command = fmt::format("pdfcairo enhanced size {:.4f}in,{:.4f}in fontscale 0.75 linewidth {:.4g} "
                                       "dashlength {:.4g}",
                                       width, height, 1.5 * stroke, dash_of_cairo * stroke);
    } else if (ending == "tex") {
        terminal.point = 0.75;
        terminal.latex = true;
        terminal.font = figure.style.font;
        terminal.command = fmt::format("cairolatex pdf input size {:.4f}in,{:.4f}in linewidth {:.4g} dashlength {:.4g}",
                                       width, height, 1.5 * stroke, dash_of_cairo * stroke);
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

/// Writes one figure in the language of gnuplot.
class FigureScript {
public:
    FigureScript(const Figure& figure, const std::string& ending)
        : figure_(&figure), page_(layout_of(figure)), terminal_(terminal_of(figure, page_, ending)),
          symbol_(terminal_.point * mark_size(page_.font) / 4.5) {}

    std::string text(const std::string& output) {
        std::string text = "set terminal " + terminal_.command + '\n';
        if (!terminal_.latex)
            text += "set termoption enhanced\n";
        text += "set output " + quoted_path(output) + "\nset encoding utf8\n";
        text += "set tics out nomirror scale 0.6,0.35\nset border lw 0.8\nunset key\nset multiplot\n";
        for (std::size_t p = 0; p < figure_->panels.size(); ++p) {
            text += "unset arrow\nunset label\n";
            if (p == 0) {
                for (const PlacedText& line : page_.title)
                    text += text_command(line);
                text += legend_commands(page_.legend);
            }
            text += panel_commands(figure_->panels[p], page_.panels[p]);
        }
        return text + "unset multiplot\nset output\n";
    }

private:
    std::string at(const PlanePoint& point) const {
        return fmt::format("screen {:.6f},{:.6f}", point.x / page_.width, point.y / page_.height);
    }

    /// LaTeX is told the size of letters in the text: gnuplot's own would not reach it.
    std::string text_of(const RichText& rich, double size) const {
        const std::string text = terminal_.text(rich);
        return terminal_.latex && size != page_.font
                   ? fmt::format("\\\\fontsize{{{:.4g}}}{{{:.4g}}}\\\\selectfont{{}}{}", size, 1.2 * size, text)
                   : text;
    }

    std::string text_command(const PlacedText& placed) const {
        using Align = PlacedText::Align;
        const char* align = placed.align == Align::left ? "left" : placed.align == Align::centre ? "center" : "right";
        return fmt::format("set label \"{}\" at {} {}{} {}\n", text_of(placed.text, placed.size), at(placed.at), align,
                           placed.upright ? " rotate by 90" : "", terminal_.font_text(placed.size));
    }

    static std::string line_text(const FigureSeries::Style style, double wider = 0) {
        switch (style) {
        case FigureSeries::Style::dashed:
            return fmt::format("lw {:.3g} dt (7,4)", 1.3 + wider);
        case FigureSeries::Style::dotted:
            return fmt::format("lw {:.3g} dt (2,3.5)", 1.1 + wider);
        case FigureSeries::Style::impulses:
            return "lw 1.1";
        default:
            return fmt::format("lw {:.3g}", 1.3 + wider);
        }
    }

    /// @param over how many series lie on this one
    std::string style_text(const FigureSeries& series, std::size_t over) const {
        const std::string colour = fmt::format("lc rgb '{}'", colour_text(series.colour));
        switch (series.style) {
        case FigureSeries::Style::dots:
            return fmt::format("with points pt 7 ps {:.3g} {}", 0.17 * symbol_, colour);
        case FigureSeries::Style::circles:
            return fmt::format("with points pt 6 ps {:.3g} lw 1.2 {}", circle_size(series.colour), colour);
        case FigureSeries::Style::symbols: {
            constexpr std::size_t many = 200; // beyond, thin small ones hide less of one another
            const bool crowded = series.points.size() > many;
            return fmt::format("with points pt {} ps {:.3g} lw {} {}", series.symbol, (crowded ? 0.6 : 1) * symbol_,
                               crowded ? 0.7 : 1.2, colour);
        }
        case FigureSeries::Style::impulses: {
            // Spectra may coincide: the first are drawn wide, so that each is seen beside those on it.
            const auto wider = static_cast<double>(over);
            return fmt::format("with linespoints pt 7 ps {:.3g} lw {:.3g} {}", (0.45 + 0.2 * wider) * symbol_,
                               1.1 + 0.6 * wider, colour);
        }
        case FigureSeries::Style::cells:
            return fmt::format("with boxxyerror fs solid 1 noborder {}", colour);
        default: // each line on it leaves an edge of it
            return fmt::format("with lines {} {}", line_text(series.style, 1.6 * static_cast<double>(over)), colour);
        }
    }

    /// Circles of different colours may lie in one place, where each is to be seen.
    double circle_size(std::size_t colour) const {
        constexpr double wider = 0.4;
        if (colour >= FigureSeries::grey)
            return symbol_;
        return symbol_ * (1 + wider * static_cast<double>(colour % 3));
    }

    /// A sample of each style, and what it is.
    std::string legend_commands(const std::vector<LegendEntry>& legend) const {
        using Style = FigureSeries::Style;
        std::string text;
        for (const LegendEntry& entry : legend) {
            const double y = (entry.box.low + entry.box.high) / 2, right = entry.box.left + entry.sample;
            const PlanePoint middle{(entry.box.left + right) / 2, y};
            const bool line = entry.style == Style::line || entry.style == Style::dashed ||
                              entry.style == Style::dotted || entry.style == Style::impulses;
            const std::string colour = colour_text(entry.colour);
            if (entry.sampled && line)
                text += sample_commands(entry, right, y, colour);
            else if (entry.sampled)
                text += fmt::format("set label \"\" at {} point pt {} ps {:.3g} lw 1.2 lc rgb '{}'\n", at(middle),
                                    entry.style == Style::symbols   ? entry.symbol
                                    : entry.style == Style::circles ? 6
                                    : entry.style == Style::cells   ? 5
                                                                    : 7,
                                    (entry.style == Style::cells ? 1.4 : 1) * symbol_, colour);
            text += fmt::format("set label \"{}\" at {} left {}\n", text_of(entry.text, legend_font(page_.font)),
                                at({entry.title_left, y}), terminal_.font_text(legend_font(page_.font)));
        }
        return text;
    }

    /// A line of a style, dash by dash: not all of gnuplot's terminals have arrows with dashes.
    std::string sample_commands(const LegendEntry& entry, double right, double y, const std::string& colour) const {
        const bool dashed = entry.style == FigureSeries::Style::dashed,
                   dotted = entry.style == FigureSeries::Style::dotted;
        const double stroke = page_.font / usual_font;
        const double length = dashed   ? 4 * stroke
                              : dotted ? stroke
                                       : right - entry.box.left,
                     gap = (dashed ? 2.2 : 2) * stroke; // points
        const std::string width = dotted ? "lw 1.1" : dashed ? "lw 1.3" : line_text(entry.style);
        std::string text;
        for (double x = entry.box.left; x < right; x += length + gap)
            text += fmt::format("set arrow from {} to {} nohead {} lc rgb '{}'\n", at({x, y}),
                                at({std::min(x + length, right), y}), width, colour);
        return text;
    }

    std::string label_commands(const LabelPlaces& places) const {
        std::string text;
        for (const PlacedLabel& label : places.labels) {
            const PlanePoint middle{(label.box.left + label.box.right) / 2, (label.box.low + label.box.high) / 2};
            text += fmt::format("set label \"{}\" at {} center {} tc rgb '{}' front\n",
                                text_of(rich(label.text), label_font(page_.font)), at(middle),
                                terminal_.font_text(label_font(page_.font)), colour_text(label.colour));
            if (label.led)
                text += fmt::format("set arrow from {} to {} nohead lw 0.5 lc rgb '#606060' front\n",
                                    at(label.leader_start), at(label.leader_end));
        }
        return text;
    }

    static std::string axis_commands(const char* name, const PanelAxis& axis) {
        std::string tics;
        for (const PanelAxis::Tic& tic : axis.tics)
            tics += fmt::format("{}\"\" {:.12g}", tics.empty() ? "" : ", ", tic.value);
        for (const double minor : axis.minor)
            tics += fmt::format("{}\"\" {:.12g} 1", tics.empty() ? "" : ", ", minor);
        return fmt::format("{1}set logscale {0}\nset {0}range [{2:.12g}:{3:.12g}]\nset {0}tics ({4})\n", name,
                           axis.logarithmic ? "" : "un", axis.low, axis.high, tics);
    }

    std::string panel_commands(const FigurePanel& panel, const PanelLayout& layout) const {
        const Box& frame = layout.frame;
        std::string text = fmt::format("set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\nset bmargin at "
                                       "screen {:.6f}\nset tmargin at screen {:.6f}\n",
                                       frame.left / page_.width, frame.right / page_.width, frame.low / page_.height,
                                       frame.high / page_.height);
        text += axis_commands("x", layout.x) + axis_commands("y", layout.y);
        for (const PlacedText& placed : layout.texts)
            text += text_command(placed);
        text += legend_commands(layout.legend);
        for (const double mark : panel.marks) {
            if (!(layout.x.share(mark) >= 0 && layout.x.share(mark) <= 1)) // gnuplot would draw it beside the panel
                continue;
            text += fmt::format(
                "set arrow from first {0:.10g},graph 0 to first {0:.10g},graph 1 nohead lw 0.5 dt (2,3.5) lc "
                "rgb '#808080'\n",
                mark);
        }
        text += label_commands(layout.labels);
        const std::string plots = plot_commands(panel, layout);
        if (!plots.empty())
            return text + plots;
        return text + fmt::format("set label \"no data\" at {} center\nplot 1/0 notitle\n",
                                  at({(frame.left + frame.right) / 2, (frame.low + frame.high) / 2}));
    }

    std::string plot_commands(const FigurePanel& panel, const PanelLayout& layout) const {
        std::string plots, data;
        // Inline data: what gnuplot calls blocks takes it quadratic time to read.
        const auto add = [&](const std::string& points, const std::string& style) {
            if (points.find_first_not_of('\n') == std::string::npos)
                return;
            data += points + "e\n";
            plots += fmt::format("{}'-' {} notitle", plots.empty() ? "" : ", ", style);
        };
        const bool cells = std::any_of(panel.series.begin(), panel.series.end(),
                                       [](const FigureSeries& series) { return !series.cells.empty(); });
        const std::vector<std::size_t> covering = covering_lines(panel, layout);
        bool dots = false;
        for (std::size_t s = 0; s < panel.series.size(); ++s) {
            const FigureSeries& series = panel.series[s];
            if (series.style == FigureSeries::Style::dots) {
                if (!dots)
                    add_dots(panel, layout, add);
                dots = true;
                continue;
            }
            if (const std::size_t last = last_of_crosses(panel, s); last > s) {
                FigureSeries part = series;
                for (CrossLayer& layer : mingled_crosses(panel, s, last)) {
                    part.points = std::move(layer.points);
                    add(data_text(part, panel, layout), style_text(panel.series[layer.series], covering[layer.series]));
                }
                s = last;
                continue;
            }
            if (cells && series.style == FigureSeries::Style::symbols) // seen on any colour
                add(data_text(series, panel, layout),
                    fmt::format("with points pt 7 ps {:.3g} lc rgb 'white'", 2 * symbol_));
            add(data_text(series, panel, layout),
                style_text(series,
                           series.style == FigureSeries::Style::impulses ? panel.series.size() - 1 - s : covering[s]));
        }
        return data.empty() ? "" : "plot " + plots + '\n' + data;
    }

    /// The points of a line that shows the same: of others so near that they are level gnuplot moves some to whole
    /// dots, which is seen as a notch.
    static Polyline thinned(const Polyline& line, const PanelLayout& layout) {
        if (layout.x.logarithmic || layout.y.logarithmic)
            return line;
        return simplified(line, layout.x.high - layout.x.low, layout.y.high - layout.y.low, unseen);
    }

    static std::string data_text(const FigureSeries& series, const FigurePanel& panel, const PanelLayout& layout) {
        using Style = FigureSeries::Style;
        const bool line = series.style == Style::line || series.style == Style::dashed || series.style == Style::dotted;
        std::string text;
        for (const PlaneBox& cell : series.cells)
            text += fmt::format("{:.10g} {:.10g} {:.10g} {:.10g} {:.10g} {:.10g}\n", (cell.left + cell.right) / 2,
                                (cell.low + cell.high) / 2, cell.left, cell.right, cell.low, cell.high);
        Polyline piece;
        const auto write = [&] {
            for (const PlanePoint& point : line ? thinned(piece, layout) : piece)
                text += fmt::format("{:.10g} {:.10g}\n", point.x, point.y);
            piece.clear();
        };
        for (const PlanePoint& point : smoothed(series.points, series.along, series.corners))
            if (is_drawn(point, panel)) {
                piece.push_back(point);
            } else {
                write();
                text += '\n';
            }
        write();
        return text;
    }

    static constexpr std::size_t few = 1000, crowd = 20000;

    /// @param add is given data and style
    template <class Add>
    void add_dots(const FigurePanel& panel, const PanelLayout& layout, const Add& add) const {
        const std::vector<MingledDot> dots = mingled_dots(panel, layout);
        if (dots.size() > few && !terminal_.pixels)
            return add_strokes(panel, layout, dots, add);
        std::string text;
        for (const MingledDot& dot : dots)
            text +=
                fmt::format("{:.7g} {:.7g} {}\n", dot.at.x, dot.at.y, colour_number(panel.series[dot.series].colour));
        const double size = dots.size() > few ? 0.17 : 0.22;
        const std::string style =
            dots.size() > crowd ? "with dots" : fmt::format("with points pt 7 ps {:.3g}", size * symbol_);
        add(text, style + " lc rgb variable");
    }

    /// A file with each dot of a crowd would have tens of megabytes.
    template <class Add>
    void add_strokes(const FigurePanel& panel, const PanelLayout& layout, const std::vector<MingledDot>& dots,
                     const Add& add) const {
        constexpr double of_unit = 0.75; ///< points: what is as wide as gnuplot's unit where lines are as usual
        const double width = dots.size() > crowd ? 1 : 0.17 * mark_size(page_.font); // as those of dots
        std::map<std::pair<std::size_t, std::size_t>, std::string> texts;            // by layer, then by series
        for (const DotStroke& stroke : dot_strokes(dots, layout, width))
            texts[{stroke.layer, stroke.series}] +=
                fmt::format("{:.7g} {:.7g}\n{:.7g} {:.7g}\n\n", stroke.from.x, stroke.from.y, stroke.to.x, stroke.to.y);
        for (const auto& [key, text] : texts)
            add(text, fmt::format("with lines lw {:.3g} lc rgb '{}'", width / (of_unit * page_.font / usual_font),
                                  colour_text(panel.series[key.second].colour)));
    }

    const Figure* figure_;
    FigureLayout page_;
    Terminal terminal_;
    double symbol_; ///< gnuplot's size of symbols
};

std::string contents_of(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string without_ending(const std::string& path) {
    return path.substr(0, path.rfind('.'));
}

/// LaTeX's text names the file with the lines, which is to stand beside it under the picture's name.
void take_latex(const FileReplacement& file, const std::string& path, double font) {
    const std::string drawn = without_ending(file.temporary_path());
    const std::string lines = contents_of(drawn + ".pdf");
    std::error_code error;
    std::filesystem::remove(drawn + ".pdf", error);
    std::string text = contents_of(file.temporary_path());
    const std::string name = std::filesystem::path(without_ending(path)).filename().string();
    for (std::size_t found = text.find(drawn); found != std::string::npos;
         found = text.find(drawn, found + name.size()))
        text.replace(found, drawn.size(), name);
    const std::string begin = "\\begingroup";
    if (const std::size_t found = text.find(begin); found != std::string::npos)
        text.insert(found + begin.size(), fmt::format("\\fontsize{{{:g}}}{{{:g}}}\\selectfont", font, 1.2 * font));
    write_file(without_ending(path) + ".pdf", lines);
    file.write(text);
}

} // namespace

const char* colour_text(std::size_t colour) {
    static const auto texts = [] {
        std::array<std::string, palette.size()> result;
        std::transform(palette.begin(), palette.end(), result.begin(),
                       [](std::uint32_t number) { return fmt::format("#{:06x}", number); });
        return result;
    }();
    if (colour == FigureSeries::grey)
        return "#b0b0b0";
    return colour == FigureSeries::black ? "#000000" : texts[colour % texts.size()].c_str();
}

std::string figure_script(const Figure& figure, const std::string& ending, const std::string& output) {
    return FigureScript(figure, ending).text(output);
}

std::vector<std::string> figure_endings() {
    return {"svg", "png", "pdf", "tex"};
}

void draw_figure(const Figure& figure, const std::string& path, const std::string& data_path) {
    const std::string ending = picture_ending(path, "--output", figure_endings());
    require_drawing_program("gnuplot", "install gnuplot (Debian: apt-get install gnuplot-nox)");
    require_distinct({{"the picture", path}, {"--data", data_path}});
    if (!data_path.empty())
        write_file(data_path, figure_script(figure, ending, path));
    FileReplacement file(path);
    draw_by_gnuplot(figure_script(figure, ending, file.temporary_path()), file, ending, path,
                    "keep its commands by --data FILE and run gnuplot FILE");
    if (ending == "tex")
        take_latex(file, path, layout_of(figure).font);
    file.commit();
}

} // namespace graze
