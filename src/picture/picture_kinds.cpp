#include "picture/picture_kinds.hpp"

#include "graze/base/input_error.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/stored_study.hpp"
#include "picture/box.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace graze {

namespace {

/// The look of points without an attractor: gnuplot's symbol for points, gnuplot's pattern for cells.
struct LabelLook {
    Label label;
    std::size_t colour;
    int symbol, hatch;
};

constexpr std::array<LabelLook, 8> label_looks{{
    {Label::unsettled, FigureSeries::grey, 2, 4},
    {Label::transient, FigureSeries::grey, 6, 3},
    {Label::escaped, FigureSeries::grey, 1, 5},
    {Label::unbounded, FigureSeries::grey, 8, 7},
    {Label::ended, FigureSeries::grey, 4, 6},
    {Label::chattering, FigureSeries::grey, 10, 1},
    {Label::singular, FigureSeries::black, 12, 2},
    {Label::failed, FigureSeries::black, 3, 0},
}};

} // namespace

std::vector<std::string> chosen_values(const StudyPicture& picture, const StoredRun& run) {
    if (!picture.y.empty())
        return picture.y;
    return run.value_names();
}

void require_values(const StudyPicture& picture, const StoredRun& run, const std::vector<std::string>& names) {
    const std::vector<std::string> known = run.value_names();
    for (const std::string& name : names)
        if (!run.has_value(name))
            throw InputError(picture.place, fmt::format("run '{}' has no value '{}'", run.record.name, name),
                             name_advice(name, known, "it has none"));
}

std::string first_coordinate(const StudyPicture& picture, const StoredRun& run) {
    if (!picture.x.empty())
        return picture.x;
    if (run.record.coordinates.empty())
        throw InputError(picture.place, fmt::format("run '{}' varies nothing", run.record.name),
                         "draw its history instead");
    return run.record.coordinates.front().name;
}

std::vector<std::string> shown_samplings(const StudyPicture& picture, const StoredRun& run) {
    return picture.samplings.empty() ? run.record.samplings : picture.samplings;
}

std::vector<std::string> row_samplings(const StoredRun& run) {
    std::vector<std::string> names;
    if (run.record.kind == "record")
        for (const RecordSampling& sampling : stored_run(run.record).record().samplings)
            if (sampling.kind == RecordSampling::Kind::record)
                names.push_back(sampling.name);
    return names;
}

std::vector<std::string> shown_points(const StudyPicture& picture, const StoredRun& run) {
    std::vector<std::string> names = shown_samplings(picture, run);
    if (picture.samplings.empty())
        for (const std::string& rows : row_samplings(run))
            std::erase(names, rows);
    return names;
}

FigurePanel panel_of(const StudyPicture& picture, const StoredRun& run, const std::string& x, const std::string& y,
                     std::size_t index) {
    FigurePanel panel = empty_panel(picture);
    label_axes(panel, picture, run, x, y);
    apply_labels(panel, picture, index);
    return panel;
}

FigurePanel empty_panel(const StudyPicture& picture) {
    FigurePanel panel;
    panel.logarithmic_x = picture.logarithmic_x;
    panel.logarithmic_y = picture.logarithmic_y;
    panel.x_range = picture.x_range;
    panel.y_range = picture.y_range;
    return panel;
}

std::string panel_letter(std::size_t index) {
    std::string letters;
    for (std::size_t remaining = index + 1; remaining > 0; remaining = (remaining - 1) / 26)
        letters.insert(letters.begin(), static_cast<char>('a' + (remaining - 1) % 26));
    return fmt::format("({})", letters);
}

void drop_constant_panels(Figure& figure) {
    std::map<std::string, Extent> extents; // of each y label over all its panels
    for (const FigurePanel& panel : figure.panels)
        for (const FigureSeries& series : panel.series)
            for (const PlanePoint& point : series.points)
                if (std::isfinite(point.y))
                    extents[panel.y_label].add(point.y);
    std::set<std::string> all, kept;
    for (const FigurePanel& panel : figure.panels) {
        all.insert(panel.y_label);
        if (!extents[panel.y_label].is_constant())
            kept.insert(panel.y_label);
    }
    if (kept.empty() || kept.size() == all.size())
        return;
    if (figure.columns == all.size())
        figure.columns = kept.size();
    std::vector<FigurePanel> panels;
    for (std::size_t p = 0; p < figure.panels.size(); ++p) {
        FigurePanel& panel = figure.panels[p];
        if (!kept.contains(panel.y_label))
            continue;
        if (const std::string letter = panel_letter(p); panel.title.starts_with(letter))
            panel.title.replace(0, letter.size(), panel_letter(panels.size()));
        panels.push_back(std::move(panel));
    }
    figure.panels = std::move(panels);
}

std::vector<double> samples_of(const PointRecord& point, const StoredRun& run, const std::string& value,
                               const std::string& sampling, std::vector<double>* times) {
    std::vector<double> result;
    const SampleSet& samples = point.result.samples;
    std::size_t column = 0;
    while (column < run.record.values.size() && run.record.values[column].name != value)
        ++column;
    for (std::size_t s = 0; s < samples.size() && column < samples.width; ++s)
        if (run.record.samplings[samples.samplings[s]] == sampling) {
            result.push_back(samples.values[s * samples.width + column]);
            if (times)
                times->push_back(samples.times[s]);
        }
    return result;
}

DrawnAs drawn_as(std::string_view label) {
    for (const Label settled : {Label::periodic, Label::quasi_periodic, Label::chaotic, Label::equilibrium})
        if (label == name_of(settled))
            return DrawnAs::attractor;
    return label == name_of(Label::unsettled) || label == name_of(Label::transient) ? DrawnAs::uncertain
                                                                                    : DrawnAs::nothing;
}

bool seeks_attractors(const RunRecord& run) {
    const auto kind = run_kind(run.kind);
    return kind && seeks_attractors(*kind);
}

std::string note_of_left_out(const StoredRun& run, const std::vector<std::string>& directions) {
    if (!seeks_attractors(run.record))
        return "";
    std::map<std::string, std::size_t> counts;
    std::size_t all = 0;
    auto rows = run.rows({.columns = {"label"}, .directions = directions});
    for (; rows.next(); ++all)
        if (const std::string label = rows.text(0); drawn_as(label) == DrawnAs::nothing)
            ++counts[label];
    std::vector<std::string> parts;
    for (const auto& [label, count] : counts)
        parts.push_back(fmt::format("{} {}", count, label));
    return parts.empty() ? ""
                         : fmt::format("without an attractor, not drawn: {} of {} points", fmt::join(parts, ", "), all);
}

FigureSeries series_of_label(std::string_view label) {
    const auto found = std::find_if(label_looks.begin(), label_looks.end(),
                                    [&](const LabelLook& one) { return label == name_of(one.label); });
    const LabelLook& look = found == label_looks.end() ? label_looks.front() : *found;
    return {.style = FigureSeries::Style::symbols, .colour = look.colour, .symbol = look.symbol, .hatch = look.hatch};
}

void add_if_drawn(FigurePanel& panel, FigureSeries series) {
    if (!series.points.empty())
        panel.series.push_back(std::move(series));
}

void show_point(FigurePanel& panel, std::size_t first, const std::string& run, std::size_t number) {
    for (std::size_t s = first; s < panel.series.size(); ++s) {
        panel.series[s].run = run;
        panel.series[s].numbers.assign(panel.series[s].points.size(), number);
    }
}

} // namespace graze
