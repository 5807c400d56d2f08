#include "graze/picture/figure_script.hpp"

#include "graze/base/input_error.hpp"
#include "picture/curve.hpp"
#include "picture/figure_layout.hpp"
#include "picture/figure_look.hpp"
#include "picture/gnuplot_text.hpp"
#include "picture/interleaved_points.hpp"
#include "picture/joined_cells.hpp"
#include "picture/page_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace graze {

namespace {

/// Greatest deviation of a simplified line, as a fraction of the panel's size.
constexpr double invisible_step = 1e-4;

/// Diameter of dots in points, smaller if there are many dots; it is the same in all panels of a picture.
double dot_width(std::size_t dots, bool pixels) {
    constexpr double largest = 2, few = 50, falling = 0.27;
    return std::clamp(largest * std::pow(few / static_cast<double>(std::max<std::size_t>(dots, 1)), falling),
                      pixels ? 0.36 : 0.5, largest);
}

/// Writes the gnuplot commands of one figure.
class FigureScript {
public:
    FigureScript(const Figure& figure, const std::string& ending)
        : figure_(&figure), page_(layout_of(figure)), terminal_(terminal_of(figure.style, page_, ending)),
          symbol_(terminal_.point * mark_size(page_.font) / 4.5) {
        std::size_t most = 0;
        for (std::size_t p = 0; p < figure.panels.size(); ++p) {
            dots_.push_back(interleaved_dots(figure.panels[p], page_.panels[p]));
            most = std::max(most, dots_.back().size());
        }
        dot_width_ = dot_width(most, terminal_.pixels) * stroke();
    }

    std::string text(const std::string& output) {
        std::string text = "set terminal " + terminal_.command + '\n';
        if (!terminal_.latex)
            text += "set termoption enhanced\n";
        text += "set output " + quoted_path(output) + "\nset encoding utf8\n";
        text += "set tics out nomirror scale 0.6,0.35\nset border lw 0.8\nunset key\nset multiplot\n";
        for (std::size_t p = 0; p < figure_->panels.size(); ++p) {
            text += "unset arrow\nunset label\nunset object\n";
            if (p == 0) {
                for (const PlacedText& line : page_.title)
                    text += text_command(line);
                text += legend_commands(page_.legend);
            }
            text += panel_commands(p);
        }
        return text + "unset multiplot\nset output\n";
    }

private:
    bool grey() const { return figure_->style.grey; }
    /// Factor of all line widths, which are proportional to the font size.
    double stroke() const { return page_.font / font_of_strokes; }

    std::string at(const PlanePoint& point) const {
        return fmt::format("screen {:.6f},{:.6f}", point.x / page_.width, point.y / page_.height);
    }

    /// The markup of a text. LaTeX gets the font size as a command in the text, since it ignores gnuplot's.
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

    static double line_width(const FigureSeries::Style style) {
        return style == FigureSeries::Style::dotted || style == FigureSeries::Style::impulses ? 1.1 : 1.3;
    }

    /// @param over number of series that cover this one
    std::string style_text(const FigureSeries& series, std::size_t over) const {
        const auto wider = static_cast<double>(over);
        const std::string colour = fmt::format("lc rgb '{}'", colour_text(series.colour, grey()));
        switch (series.style) {
        case FigureSeries::Style::dots:
            return fmt::format("with points pt 7 ps {:.3g} {}", 0.17 * symbol_, colour);
        case FigureSeries::Style::circles:
            return fmt::format("with points pt {} ps {:.3g} lw 1.2 {}", grey() ? circle_mark(series.colour) : 6,
                               circle_size(series.colour), colour);
        case FigureSeries::Style::symbols: {
            constexpr std::size_t many = 200; // more symbols are drawn smaller and thinner, so that they overlap less
            constexpr std::size_t very_many = 1000;
            const std::size_t count = series.points.size();
            return fmt::format("with points pt {} ps {:.3g} lw {} {}", series.symbol,
                               (count > very_many ? 0.35
                                : count > many    ? 0.6
                                                  : 1) *
                                   symbol_,
                               count > many ? 0.7 : 1.2, colour);
        }
        case FigureSeries::Style::impulses: // spectra may coincide: the first are drawn wider than the later ones
            return fmt::format("with linespoints pt 7 ps {:.3g} lw {:.3g} {}", (0.45 + 0.2 * wider) * symbol_,
                               line_width(series.style) + 0.6 * wider, colour);
        case FigureSeries::Style::cells:
            return fmt::format("with boxxyerror {} lc rgb '#{:06x}'", fill_text(series.colour, series.hatch),
                               cell_number(series.colour, grey()));
        default: // wider than the lines that cover it, so that its edges are visible
            return fmt::format("with lines lw {:.3g} {}", line_width(series.style) + 1.6 * wider, colour);
        }
    }

    /// The fill of cells: a pattern if the colour alone does not distinguish them.
    std::string fill_text(std::size_t colour, int hatch) const {
        const int pattern = hatch != 0 ? hatch : grey() ? cell_hatch(colour) : 0;
        return pattern != 0 ? fmt::format("fs transparent pattern {} noborder", pattern) : "fs solid 1 noborder";
    }

    /// Diameter of circles: it depends on the colour, so that circles at the same point are all visible.
    double circle_size(std::size_t colour) const {
        constexpr double wider = 0.4;
        return colour >= FigureSeries::grey ? symbol_ : symbol_ * (1 + wider * static_cast<double>(colour % 3));
    }

    /// Commands for the samples and texts of a legend.
    std::string legend_commands(const std::vector<LegendEntry>& legend) const {
        std::string text;
        for (const LegendEntry& entry : legend) {
            const double y = entry.box.middle().y;
            if (entry.sampled)
                text += sample_commands(entry, y);
            text += fmt::format("set label \"{}\" at {} left {}\n", text_of(entry.text, legend_font(page_.font)),
                                at({entry.title_left, y}), terminal_.font_text(legend_font(page_.font)));
        }
        return text;
    }

    std::string sample_commands(const LegendEntry& entry, double y) const {
        using Style = FigureSeries::Style;
        const double left = entry.box.left, right = left + entry.sample;
        const PlanePoint middle{(left + right) / 2, y};
        const std::string colour = colour_text(entry.colour, grey());
        const auto point = [&](int symbol, double size) {
            return fmt::format("set label \"\" at {} point pt {} ps {:.3g} lw 1.2 lc rgb '{}'\n", at(middle), symbol,
                               size * symbol_, colour);
        };
        switch (entry.style) {
        case Style::symbols:
            return point(entry.symbol, 1);
        case Style::circles:
            return point(grey() ? circle_mark(entry.colour) : 6, 1);
        case Style::dots:
            return fmt::format("set label \"\" at {} point pt 7 ps {:.3g} lc rgb '#{:06x}'\n", at(middle), symbol_,
                               dot_number(entry.colour, grey()));
        case Style::cells: {
            const double half = entry.sample / 2;
            return fmt::format("set object rectangle from {} to {} noclip fc rgb '#{:06x}' {}\n", at({left, y - half}),
                               at({right, y + half}), cell_number(entry.colour, grey()),
                               fill_text(entry.colour, entry.hatch));
        }
        default: {
            std::string text = line_sample(entry, y, colour);
            if (const int mark = grey() ? line_mark(entry.colour) : 0; mark != 0)
                text += point(mark, line_mark_size);
            return text;
        }
        }
    }

    /// Commands for a sample of a line style, dash by dash.
    std::string line_sample(const LegendEntry& entry, double y, const std::string& colour) const {
        const double left = entry.box.left, right = left + entry.sample;
        const bool whole = entry.style == FigureSeries::Style::line || entry.style == FigureSeries::Style::impulses;
        const DashPattern pattern = whole ? DashPattern{entry.sample, 1} : dash_pattern(entry.style, stroke());
        std::string text;
        for (double x = left; x < right; x += pattern.length())
            text += fmt::format("set arrow from {} to {} nohead lw {} lc rgb '{}'\n", at({x, y}),
                                at({std::min(x + pattern.dash, right), y}), line_width(entry.style), colour);
        return text;
    }

    std::string label_commands(const LabelPlaces& places) const {
        std::string text;
        for (const PlacedLabel& label : places.labels) {
            text += fmt::format("set label \"{}\" at {} center {} tc rgb '{}' front\n",
                                text_of(rich(label.text), label_font(page_.font)), at(label.box.middle()),
                                terminal_.font_text(label_font(page_.font)),
                                colour_text(grey() ? FigureSeries::black : label.colour));
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

    std::string panel_commands(std::size_t number) const {
        const PanelLayout& layout = page_.panels[number];
        const Box& frame = layout.frame;
        std::string text = fmt::format("set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\nset bmargin at "
                                       "screen {:.6f}\nset tmargin at screen {:.6f}\n",
                                       frame.left / page_.width, frame.right / page_.width, frame.low / page_.height,
                                       frame.high / page_.height);
        text += axis_commands("x", layout.x) + axis_commands("y", layout.y);
        for (const PlacedText& placed : layout.texts)
            text += text_command(placed);
        text += legend_commands(layout.legend);
        text += label_commands(layout.labels);
        const std::string plots = plot_commands(number);
        if (!plots.empty())
            return text + plots;
        return text + fmt::format("set label \"no data\" at {} center\nplot 1/0 notitle\n", at(frame.middle()));
    }

    std::string plot_commands(std::size_t number) const {
        const FigurePanel& panel = figure_->panels[number];
        const PanelLayout& layout = page_.panels[number];
        std::string plots, data;
        // Inline data ('-'), since gnuplot needs quadratic time to read datablocks.
        const auto add = [&](const std::string& points, const std::string& style) {
            if (points.find_first_not_of('\n') == std::string::npos)
                return;
            data += points + "e\n";
            plots += fmt::format("{}'-' {} notitle", plots.empty() ? "" : ", ", style);
        };
        const double disc = width_of_discs(panel);
        const std::vector<std::size_t> covering = covering_lines(panel, layout);
        bool dots = false;
        for (const double mark : panel.marks)
            add(line_text({{mark, layout.y.low}, {mark, layout.y.high}}, FigureSeries::Style::dotted, layout),
                "with lines lw 0.5 lc rgb '#808080'");
        for (std::size_t s = 0; s < panel.series.size(); ++s) {
            const FigureSeries& series = panel.series[s];
            if (series.style == FigureSeries::Style::dots) {
                if (!dots)
                    add_dots(number, add);
                dots = true;
                continue;
            }
            if (const std::size_t last = last_of_crosses(panel, s); last > s) {
                FigureSeries part = series;
                for (CrossLayer& layer : interleaved_crosses(panel, s, last)) {
                    part.points = std::move(layer.points);
                    add(data_text(part, panel, layout), style_text(panel.series[layer.series], covering[layer.series]));
                }
                s = last;
                continue;
            }
            if (disc > 0 && series.style == FigureSeries::Style::symbols)
                add(data_text(series, panel, layout),
                    fmt::format("with points pt 7 ps {:.3g} lc rgb 'white'", disc * symbol_));
            add(data_text(series, panel, layout),
                style_text(series,
                           series.style == FigureSeries::Style::impulses ? panel.series.size() - 1 - s : covering[s]));
            if (const int mark = grey() && is_line(series.style) ? line_mark(series.colour) : 0; mark != 0)
                add(marks_text(series, panel, layout),
                    fmt::format("with points pt {} ps {:.3g} lc rgb '{}'", mark, line_mark_size * symbol_,
                                colour_text(series.colour, true)));
        }
        return data.empty() ? "" : "plot " + plots + '\n' + data;
    }

    /// Width of the white discs below symbols, which make these visible on cells of any colour; 0: none are needed. On
    /// tints they are as large as the symbols, so that many symbols do not hide the rest.
    static double width_of_discs(const FigurePanel& panel) {
        bool cells = false, tints = false;
        for (const FigureSeries& series : panel.series) {
            cells = cells || !series.cells.empty();
            tints = tints || (!series.cells.empty() && series.colour >= FigureSeries::pale);
        }
        return tints ? 1 : cells ? 2 : 0;
    }

    /// Leaves out points of a line that do not change its appearance. gnuplot rounds dense points of nearly horizontal
    /// lines to pixels, which would be visible as notches.
    static Polyline thinned(const Polyline& line, const PanelLayout& layout) {
        if (layout.x.logarithmic || layout.y.logarithmic)
            return line;
        return simplified(line, layout.x.high - layout.x.low, layout.y.high - layout.y.low, invisible_step);
    }

    static std::string points_text(const std::vector<PlanePoint>& points) {
        std::string text;
        for (const PlanePoint& point : points)
            text += fmt::format("{:.10g} {:.10g}\n", point.x, point.y);
        return text;
    }

    /// The line with each point mapped by `on_page` or `off_page`.
    static Polyline mapped(const Polyline& line, PlanePoint (&map)(const PlanePoint&, const PanelLayout&),
                           const PanelLayout& layout) {
        Polyline result;
        for (const PlanePoint& point : line)
            result.push_back(map(point, layout));
        return result;
    }

    /// Data of a line. Dashes are computed here rather than by gnuplot, so that dashes of coinciding lines coincide.
    std::string line_text(const Polyline& line, FigureSeries::Style style, const PanelLayout& layout) const {
        if (style == FigureSeries::Style::line)
            return points_text(line);
        std::string text;
        for (const Polyline& dash :
             dashes_of(mapped(line, on_page, layout), dash_pattern(style, stroke()), layout.frame))
            text += points_text(mapped(dash, off_page, layout)) + '\n';
        return text;
    }

    /// The parts of a series between points that cannot be drawn.
    static std::vector<Polyline> pieces_of(const FigureSeries& series, const FigurePanel& panel) {
        std::vector<Polyline> pieces(1);
        for (const PlanePoint& point : smoothed(series.points, series.along, series.corners))
            if (is_drawn(point, panel))
                pieces.back().push_back(point);
            else
                pieces.emplace_back();
        return pieces;
    }

    /// Data of the symbols along a line, which distinguish lines in grey pictures.
    static std::string marks_text(const FigureSeries& series, const FigurePanel& panel, const PanelLayout& layout) {
        constexpr double distance = 60, first = 12, later = 9; // points
        const double start = first + later * static_cast<double>(series.colour % 6);
        std::string text;
        for (const Polyline& piece : pieces_of(series, panel))
            text += points_text(
                mapped(spread_along(mapped(piece, on_page, layout), distance, start, layout.frame), off_page, layout));
        return text;
    }

    std::string data_text(const FigureSeries& series, const FigurePanel& panel, const PanelLayout& layout) const {
        std::string text;
        for (const PlaneBox& cell : joined_cells(series))
            text += fmt::format("{:.10g} {:.10g} {:.10g} {:.10g} {:.10g} {:.10g}\n", (cell.left + cell.right) / 2,
                                (cell.low + cell.high) / 2, cell.left, cell.right, cell.low, cell.high);
        std::size_t written = 0;
        for (const Polyline& piece : pieces_of(series, panel)) {
            text += written++ > 0 ? "\n" : "";
            text +=
                is_line(series.style) ? line_text(thinned(piece, layout), series.style, layout) : points_text(piece);
        }
        return text;
    }

    /// Adds the dots of a panel. @param add receives data and style
    template <class Add>
    void add_dots(std::size_t number, const Add& add) const {
        constexpr std::size_t few = 1000;
        const FigurePanel& panel = figure_->panels[number];
        const std::vector<InterleavedDot>& dots = dots_[number];
        if (dots.size() > few && !terminal_.pixels)
            return add_strokes(number, add);
        std::string text;
        for (const InterleavedDot& dot : dots)
            text += fmt::format("{:.7g} {:.7g} {}\n", dot.at.x, dot.at.y,
                                dot_number(panel.series[dot.series].colour, grey()));
        constexpr double of_pixel = 0.4; ///< points; smaller dots are drawn as gnuplot's dots, which is fast
        const std::string style =
            terminal_.pixels && dot_width_ < of_pixel
                ? "with dots"
                : fmt::format("with points pt 7 ps {:.3g}", dot_width_ / mark_size(page_.font) * symbol_);
        add(text, style + " lc rgb variable");
    }

    /// Adds the dots of a panel as strokes: a file with every dot could have tens of megabytes.
    template <class Add>
    void add_strokes(std::size_t number, const Add& add) const {
        constexpr double of_unit = 0.75; ///< points; width of gnuplot's line width 1 at the usual font size
        std::map<std::pair<std::size_t, std::size_t>, std::string> texts; // by layer, then by series
        for (const DotStroke& stroke : dot_strokes(dots_[number], page_.panels[number], dot_width_))
            texts[{stroke.layer, stroke.series}] +=
                fmt::format("{:.7g} {:.7g}\n{:.7g} {:.7g}\n\n", stroke.from.x, stroke.from.y, stroke.to.x, stroke.to.y);
        for (const auto& [key, text] : texts)
            add(text, fmt::format("with lines lw {:.3g} lc rgb '#{:06x}'", dot_width_ / (of_unit * stroke()),
                                  dot_number(figure_->panels[number].series[key.second].colour, grey())));
    }

    static constexpr double line_mark_size = 0.75; ///< size of symbols along lines, relative to those of points
    const Figure* figure_;
    FigureLayout page_;
    FigureTerminal terminal_;
    double symbol_;                                 ///< gnuplot's size of symbols
    std::vector<std::vector<InterleavedDot>> dots_; ///< dots of each panel
    double dot_width_ = 0;                          ///< points
};

} // namespace

std::string figure_script(const Figure& figure, const std::string& ending, const std::string& output) {
    return FigureScript(figure, ending).text(output);
}

std::vector<std::string> figure_endings() {
    return {"svg", "png", "pdf", "eps", "tex"};
}

} // namespace graze
