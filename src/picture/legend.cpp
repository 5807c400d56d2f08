#include "picture/legend.hpp"

#include "picture/figure_look.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr std::size_t most_entries = 24;
// In units of the legend's font size.
constexpr double width_of_line_sample = 2.4, symbol_sample = 0.9, space = 0.5, gap_of_columns = 1.6, row_height = 1.4;

double sample_of(const LegendEntry& entry) {
    if (!entry.sampled)
        return 0;
    return is_line(entry.style) || entry.style == FigureSeries::Style::impulses ? width_of_line_sample : symbol_sample;
}

/// True for entries that explain a style, independent of the colour.
bool is_of_style(const LegendEntry& entry) {
    return entry.colour == FigureSeries::black || entry.colour == FigureSeries::grey;
}

bool same_look(const LegendEntry& a, const LegendEntry& b) {
    return a.style == b.style && a.colour == b.colour && a.symbol == b.symbol && a.hatch == b.hatch;
}

bool same_entry(const LegendEntry& a, const LegendEntry& b) {
    return a.title == b.title && same_look(a, b);
}

} // namespace

double legend_font(double font) {
    return 0.92 * font;
}

std::vector<LegendEntry> legend_entries(const FigurePanel& panel) {
    std::vector<LegendEntry> entries;
    for (const FigureSeries& series : panel.series) {
        const bool empty = series.points.empty() && series.cells.empty() && !series.only_in_legend;
        const bool known = std::any_of(entries.begin(), entries.end(), [&](const LegendEntry& entry) {
            return entry.title == series.title && entry.colour == series.colour;
        });
        if (!series.title.empty() && !empty && !known)
            entries.push_back({series.title, {}, series.style, series.colour, series.symbol, series.hatch});
    }
    if (!panel.marks_title.empty() && !panel.marks.empty())
        entries.push_back({panel.marks_title, {}, FigureSeries::Style::dotted, FigureSeries::grey});
    const auto styles = static_cast<std::size_t>(std::count_if(entries.begin(), entries.end(), is_of_style));
    if (entries.size() - styles <= most_entries)
        return entries;
    const std::size_t left_out = entries.size() - styles - (most_entries - 1);
    std::vector<LegendEntry> fewer;
    std::size_t seen = 0;
    for (const LegendEntry& entry : entries) {
        if (is_of_style(entry) || seen < most_entries - 1)
            fewer.push_back(entry);
        if (!is_of_style(entry) && ++seen == most_entries)
            fewer.push_back({fmt::format("and {} more", left_out), {}, {}, FigureSeries::black, 0, 0, false});
    }
    return fewer;
}

std::optional<std::vector<LegendEntry>> joined_legend(const std::vector<std::vector<LegendEntry>>& legends) {
    if (legends.empty())
        return std::nullopt;
    std::vector<LegendEntry> all = *std::max_element(
        legends.begin(), legends.end(), [](const auto& one, const auto& other) { return one.size() < other.size(); });
    const auto is_of_all = [&](const LegendEntry& entry) {
        return std::any_of(all.begin(), all.end(), [&](const LegendEntry& other) { return same_entry(entry, other); });
    };
    for (const std::vector<LegendEntry>& legend : legends) {
        if (!legend.empty() && std::none_of(legend.begin(), legend.end(), is_of_all))
            return std::nullopt;
        for (const LegendEntry& entry : legend) {
            if (is_of_all(entry))
                continue;
            if (std::any_of(all.begin(), all.end(), [&](const LegendEntry& other) {
                    return entry.title == other.title || same_look(entry, other);
                }))
                return std::nullopt;
            all.push_back(entry);
        }
    }
    return all;
}

double place_legend(std::vector<LegendEntry>& entries, double left, double top, double width, double font,
                    const std::vector<std::string>& symbols) {
    if (entries.empty())
        return 0;
    const double size = legend_font(font);
    double widest = 0;
    for (LegendEntry& entry : entries) {
        entry.sample = sample_of(entry) * size;
        const double before = entry.sample + (entry.sampled ? space * size : 0);
        const std::vector<std::string> lines = wrapped_lines(entry.title, (width - before) / size, 1);
        entry.text = rich_words(lines.empty() ? "" : lines.front(), symbols);
        entry.box = {0, 0, before + width_of(entry.text) * size, row_height * size};
        widest = std::max(widest, entry.box.right);
    }
    const double step = widest + gap_of_columns * size;
    const auto most = static_cast<std::size_t>(std::max(1.0, (width + gap_of_columns * size) / step));
    const std::size_t rows = (entries.size() + most - 1) / most, columns = (entries.size() + rows - 1) / rows;
    const double start = left + (width - (static_cast<double>(columns) * step - gap_of_columns * size)) / 2;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const double x = start + step * static_cast<double>(i % columns);
        const std::size_t row = i / columns + 1;
        const double y = top - row_height * size * static_cast<double>(row);
        Box& box = entries[i].box;
        box = {x, y, x + box.width(), y + box.height()};
        entries[i].title_left = x + entries[i].sample + (entries[i].sampled ? space * size : 0);
    }
    return row_height * size * static_cast<double>(rows);
}

} // namespace graze
