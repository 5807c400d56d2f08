#include "program/figure.hpp"

#include "graze/symbolic/input_error.hpp"
#include "program/curve.hpp"
#include "program/gnuplot_text.hpp"
#include "program/label_places.hpp"
#include "program/output_file.hpp"
#include "program/picture.hpp"
#include "program/process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_set>

namespace graze {

namespace {

// Pixels at 96 per inch.
constexpr double panel_width = 470, panel_height = 300, title_height = 34;
constexpr double dots_per_inch = 200;
/// Dots closer than this share of a panel are one.
constexpr double grain = 1.0 / 2000;
constexpr std::array<const char*, 8> palette{"#1f4e9c", "#c8232c", "#2a8c4a", "#d98200",
                                             "#7b3fa0", "#1797a6", "#8a5a32", "#606060"};

bool is_drawn(const PlanePoint& point, const FigurePanel& panel) {
    return std::isfinite(point.x) && std::isfinite(point.y) && (!panel.logarithmic_x || point.x > 0) &&
           (!panel.logarithmic_y || point.y > 0);
}

struct Extent {
    double least = std::numeric_limits<double>::infinity(), greatest = -std::numeric_limits<double>::infinity();
    void add(double value) {
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
    double span() const { return greatest > least ? greatest - least : 1; }
};

/// Of those dots that nobody could tell apart only one.
std::vector<PlanePoint> thinned(const FigureSeries& series, const FigurePanel& panel) {
    const auto scale = [](double value, bool logarithmic) { return logarithmic ? std::log(value) : value; };
    Extent x, y;
    for (const PlanePoint& point : series.points)
        if (is_drawn(point, panel)) {
            x.add(scale(point.x, panel.logarithmic_x));
            y.add(scale(point.y, panel.logarithmic_y));
        }
    std::unordered_set<std::uint64_t> taken;
    std::vector<PlanePoint> result;
    for (const PlanePoint& point : series.points) {
        if (!is_drawn(point, panel))
            continue;
        const double column = (scale(point.x, panel.logarithmic_x) - x.least) / (x.span() * grain);
        const double row = (scale(point.y, panel.logarithmic_y) - y.least) / (y.span() * grain);
        const std::uint64_t cell = static_cast<std::uint64_t>(column) << 32 | static_cast<std::uint64_t>(row);
        if (taken.insert(cell).second)
            result.push_back(point);
    }
    return result;
}

std::string style_text(const FigureSeries& series, bool crowded) {
    const char* colour = colour_text(series.colour);
    switch (series.style) {
    case FigureSeries::Style::dots:
        return crowded ? fmt::format("with dots lc rgb '{}'", colour)
                       : fmt::format("with points pt 7 ps 0.15 lc rgb '{}'", colour);
    case FigureSeries::Style::circles:
        return fmt::format("with points pt 6 ps 0.8 lw 1.4 lc rgb '{}'", colour);
    case FigureSeries::Style::line:
        return fmt::format("with lines lw 1.3 lc rgb '{}'", colour);
    case FigureSeries::Style::dashed:
        return fmt::format("with lines lw 1.3 dt (7,4) lc rgb '{}'", colour);
    case FigureSeries::Style::dotted:
        return fmt::format("with lines lw 0.9 dt 3 lc rgb '{}'", colour);
    case FigureSeries::Style::symbols:
        return fmt::format("with points pt {} ps 0.8 lw 1.2 lc rgb '{}'", series.symbol, colour);
    case FigureSeries::Style::impulses:
        return fmt::format("with linespoints pt 7 ps 0.4 lw 1.1 lc rgb '{}'", colour);
    }
    return "";
}

std::string range_text(const std::optional<std::pair<double, double>>& range) {
    return range ? fmt::format("[{}:{}]", number_text(range->first), number_text(range->second)) : "[*:*]";
}

/// Fewer tics than usual where their labels are so long that they would run into one another.
std::string tics_text(const FigurePanel& panel) {
    Extent extent;
    if (panel.x_range) {
        extent.add(panel.x_range->first);
        extent.add(panel.x_range->second);
    } else {
        for (const FigureSeries& series : panel.series)
            for (const PlanePoint& point : series.points)
                if (is_drawn(point, panel))
                    extent.add(point.x);
    }
    if (panel.logarithmic_x || !(extent.least < extent.greatest))
        return "set xtics autofreq\n";
    constexpr int usual = 8, few = 4;
    constexpr std::size_t room = 54; // letters
    const Axis axis = axis_for(extent.least, extent.greatest, usual, 0);
    std::size_t letters = 0;
    for (double count = std::ceil(axis.low / axis.tic); count * axis.tic <= axis.high; ++count)
        letters += fmt::format("{:g}", count * axis.tic).size() + 1;
    if (letters <= room)
        return "set xtics autofreq\n";
    return fmt::format("set xtics {:g}\n", axis_for(extent.least, extent.greatest, few, 0).tic);
}

std::string data_text(const FigureSeries& series, const FigurePanel& panel, bool& crowded) {
    const bool dots = series.style == FigureSeries::Style::dots;
    const std::vector<PlanePoint> points = dots ? thinned(series, panel) : series.points;
    constexpr std::size_t crowd = 20000;
    const int digits = dots ? 7 : 10; // lines are also drawn of narrow ranges
    crowded = points.size() > crowd;
    std::string text;
    for (const PlanePoint& point : points)
        text += is_drawn(point, panel) ? fmt::format("{:.{}g} {:.{}g}\n", point.x, digits, point.y, digits)
                                       : std::string("\n");
    return text;
}

std::string panel_commands(const FigurePanel& panel) {
    std::string text = fmt::format("set title \"{}\"\n", plain(panel.title));
    text += fmt::format("set xlabel \"{}\"\nset ylabel \"{}\"\n", with_unit(name_text(panel.x_label), panel.x_unit),
                        with_unit(name_text(panel.y_label), panel.y_unit));
    text += panel.logarithmic_x ? "set logscale x\nset format x '10^{%T}'\n" : "unset logscale x\nset format x '%g'\n";
    text += panel.logarithmic_y ? "set logscale y\nset format y '10^{%T}'\n" : "unset logscale y\nset format y '%g'\n";
    text += tics_text(panel);
    text += fmt::format("set offsets graph {0},graph {0},graph {1},graph {1}\n", panel.roomy_x ? roomy_margin : 0.0,
                        panel.roomy ? roomy_margin : 0.0);
    text += fmt::format("set xrange {}\nset yrange {}\n", range_text(panel.x_range), range_text(panel.y_range));
    text += panel.key_inside ? "set key inside bottom right vertical Left reverse\n"
                             : "set key outside bottom center horizontal noreverse\n";
    // Long enough for dashes to be seen.
    const bool styles = std::any_of(panel.series.begin(), panel.series.end(),
                                    [](const FigureSeries& series) { return series.only_in_legend; });
    text += fmt::format("set key samplen {}\n", styles ? 3 : 1);
    text += "unset arrow\nunset label\n";
    for (const double mark : panel.marks)
        text += fmt::format("set arrow from first {0},graph 0 to first {0},graph 1 nohead lw 0.5 dt 3 lc rgb "
                            "'#808080'\n",
                            fmt::format("{:.10g}", mark));
    text += label_commands(panel);
    std::string plots, data;
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
        const FigureSeries& series = panel.series[s];
        bool crowded = false;
        if (series.only_in_legend) {
            plots += fmt::format("{}NaN {} title \"{}\"", plots.empty() ? "" : ", ", style_text(series, false),
                                 plain(series.title));
            continue;
        }
        const std::string points = data_text(series, panel, crowded);
        if (points.find_first_not_of('\n') == std::string::npos)
            continue;
        // Inline data: what gnuplot calls blocks takes it quadratic time to read.
        data += points + "e\n";
        // In a legend a tiny dot would not be seen.
        const std::string title = series.title.empty() ? "notitle" : fmt::format("title \"{}\"", plain(series.title));
        const bool tiny = series.style == FigureSeries::Style::dots && !series.title.empty();
        plots += fmt::format("{}{} {} {}", plots.empty() ? "" : ", ", "'-'", style_text(series, crowded),
                             tiny ? "notitle" : title);
        if (tiny)
            plots += fmt::format(", NaN with points pt 7 ps 0.7 lc rgb '{}' {}", colour_text(series.colour), title);
    }
    if (data.empty())
        return text + "set label 99 'no data' at graph 0.5,0.5 center\nset xrange [0:1]\nset yrange [0:1]\n"
                      "plot NaN notitle\nunset label 99\n";
    return text + "plot " + plots + "\n" + data;
}

} // namespace

const char* colour_text(std::size_t colour) {
    if (colour == FigureSeries::grey)
        return "#b0b0b0";
    return colour == FigureSeries::black ? "#000000" : palette[colour % palette.size()];
}

std::string figure_script(const Figure& figure, const std::string& ending, const std::string& output) {
    const std::size_t across = std::max<std::size_t>(1, std::min(figure.columns, figure.panels.size()));
    const std::size_t down = std::max<std::size_t>(1, (figure.panels.size() + across - 1) / across);
    const double width = panel_width * static_cast<double>(across) + (across == 1 ? 170 : 0);
    const double height = panel_height * static_cast<double>(down) + (figure.title.empty() ? 0 : title_height);
    std::string text;
    if (ending == "png")
        text = fmt::format("set terminal pngcairo noenhanced size {:.0f},{:.0f} fontscale {:.4g} linewidth {:.4g} "
                           "pointscale {:.4g} font 'sans,10'\nset termoption enhanced\n",
                           width * dots_per_inch / 96, height * dots_per_inch / 96, dots_per_inch / 96,
                           dots_per_inch / 96, dots_per_inch / 96);
    else if (ending == "pdf")
        text = fmt::format("set terminal pdfcairo enhanced size {:.4g}in,{:.4g}in font 'sans,10'\n", width / 96,
                           height / 96);
    else
        text = fmt::format("set terminal svg enhanced size {:.0f},{:.0f} font 'sans,12' background rgb 'white'\n",
                           width, height);
    text += "set output " + quoted_path(output) + "\nset encoding utf8\n";
    std::string commands;
    for (const FigurePanel& panel : figure.panels)
        commands += panel_commands(panel);
    text += "set tics out nomirror\nset border lw 0.8\nset key outside bottom center horizontal nobox samplen 1 "
            "spacing 1.1\n";
    text += fmt::format("set multiplot layout {},{}", down, across);
    if (!figure.title.empty())
        text += fmt::format(" title \"{}\"", plain(figure.title));
    return text + "\n" + commands + "unset multiplot\nset output\n";
}

void draw_figure(const Figure& figure, const std::string& path, const std::string& data_path) {
    const std::string ending = picture_ending(path, "--output", {"svg", "png", "pdf"});
    const std::string gnuplot =
        require_drawing_program("gnuplot", "install gnuplot (Debian: apt-get install gnuplot-nox)");
    require_distinct({{"the picture", path}, {"--data", data_path}});
    if (!data_path.empty())
        write_file(data_path, figure_script(figure, ending, path));
    FileReplacement file(path);
    // From a file: gnuplot reads standard input letter by letter, which takes it long for many points.
    FileReplacement commands(path + ".gp");
    commands.write(figure_script(figure, ending, file.temporary_path()));
    const ProcessResult result = run_process({gnuplot, "-d", commands.temporary_path()}, "");
    if (result.status != 0)
        throw InputError(fmt::format("gnuplot could not draw '{}': {}", path, one_line(result.output)),
                         "keep its commands by --data FILE and run gnuplot FILE");
    require_whole_picture(file.temporary_path(), ending, path);
    file.commit();
}

} // namespace graze
