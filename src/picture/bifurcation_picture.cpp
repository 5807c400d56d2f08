#include "picture/box.hpp"
#include "picture/picture_kinds.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/name_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace graze {

namespace {

constexpr std::size_t most_marks = 8;
constexpr std::size_t most_overlaid_circles = 200; ///< in a series drawn over another run; more are drawn as crosses
constexpr double least_stretch = 0.01;             ///< least fraction of a sweep on either side of a marked change
/// Meaning of the dotted lines: consecutive stretches of a sweep differ in one of these.
constexpr const char* meaning_of_marks = "label, period, signature or symmetry changes";

/// Coordinates at which the kind of attractor changes between two stretches of a sweep that are long enough.
std::vector<double> places_of_change(const StoredRun& run, const std::string& direction) {
    auto rows = run.rows({.columns = {"label", "period", "symmetric", "chain", "signature"},
                          .quantities = {run.record.coordinates.front().name},
                          .directions = {direction}});
    struct Stretch {
        std::string kind;
        double first, last;
        std::size_t points;
    };
    std::vector<Stretch> stretches;
    std::size_t all = 0;
    while (rows.next()) {
        if (rows.integer(3) != 0)
            return {}; // changes of several chains would overlap
        const std::string kind = fmt::format("{} {} {} {}", rows.text(0), rows.text(1), rows.text(2), rows.text(4));
        if (stretches.empty() || stretches.back().kind != kind)
            stretches.push_back({kind, rows.number(5), rows.number(5), 0});
        stretches.back().last = rows.number(5);
        ++stretches.back().points;
        ++all;
    }
    std::vector<std::pair<double, std::size_t>> found; // places, and the points of the shorter of the two stretches
    const double least = least_stretch * static_cast<double>(all);
    const Stretch* before = nullptr;
    for (const Stretch& stretch : stretches) {
        if (static_cast<double>(stretch.points) < least)
            continue;
        if (before && before->kind != stretch.kind)
            found.emplace_back(0.5 * (before->last + stretch.first), std::min(before->points, stretch.points));
        before = &stretch;
    }
    // Keep the changes between the longest stretches.
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    found.resize(std::min(found.size(), most_marks));
    std::vector<double> marks;
    for (const auto& [at, points] : found)
        marks.push_back(at);
    return marks;
}

/// Gives panels of the same value the same axis, so that up and down can be compared.
void share_axes(Figure& figure) {
    std::map<std::string, Extent> extents;
    for (const FigurePanel& panel : figure.panels)
        for (const FigureSeries& series : panel.series)
            for (const PlanePoint& point : series.points)
                extents[panel.y_label].add(point.y);
    constexpr double margin = 0.04;
    for (FigurePanel& panel : figure.panels)
        if (const Extent& y = extents[panel.y_label]; !y.is_constant() && !panel.y_range && !panel.logarithmic_y)
            panel.y_range = std::pair(y.least - margin * y.span(), y.greatest + margin * y.span());
}

/// Value and direction of a panel, over which other runs may be drawn.
struct ShownPanel {
    std::string value, direction;
};

/// Draws a series as crosses, which are visible on a band of dots: the first black, the others in colours; upright and
/// diagonal crosses alternate.
void mark_by_crosses(FigureSeries& series, std::size_t index) {
    series.style = FigureSeries::Style::symbols;
    series.symbol = index % 2 == 0 ? 1 : 2; // gnuplot's crosses
    if (index == 0)
        series.colour = FigureSeries::black;
}

/// The text, with "name: " before it if there is a name.
std::string named_with(std::string_view text, const std::string& name) {
    return name.empty() ? std::string(text) : fmt::format("{}: {}", name, text);
}

/// Adds a series for each sampling of a run, for attractors, and one of crosses for motions that did not settle.
/// @param over the run is drawn over others: its series are named after it and drawn as circles or crosses
void add_samples_of(FigurePanel& panel, const StudyPicture& picture, const StoredRun& run, const std::string& x,
                    const ShownPanel& shown, bool over) {
    const std::vector<std::string> samplings = shown_points(picture, run);
    const std::size_t before = panel.series.size();
    // Motions that did not settle are grey and do not count, so that colours are the same in all panels.
    const auto first_colour =
        static_cast<std::size_t>(std::count_if(panel.series.begin(), panel.series.end(), [](const FigureSeries& one) {
            return one.title.empty() || one.colour != FigureSeries::grey;
        }));
    std::map<std::string, std::size_t> series;
    for (std::size_t s = 0; s < samplings.size(); ++s) {
        series[samplings[s]] = before + s;
        const std::string run_name = shown_name(picture, run.record.name);
        const std::string title = samplings.size() > 1 ? shown_name(picture, samplings[s]) : "";
        // If other runs are drawn over this one, its series are named after it too.
        const bool named = over || (!title.empty() && !picture.over.empty());
        panel.series.push_back({!named          ? title
                                : title.empty() ? run_name
                                                : fmt::format("{}: {}", run_name, title),
                                over ? FigureSeries::Style::circles : FigureSeries::Style::dots,
                                first_colour + s,
                                {}});
        panel.series.back().run = run.record.name;
    }
    const auto& known = run.record.directions;
    const bool has_direction = std::find(known.begin(), known.end(), shown.direction) != known.end();
    const std::vector<std::string> directions =
        has_direction ? std::vector<std::string>{shown.direction} : std::vector<std::string>();
    const bool judged = seeks_attractors(run.record);
    FigureSeries uncertain = series_of_label(name_of(Label::unsettled));
    uncertain.title = named_with(name_of(Label::unsettled), over ? shown_name(picture, run.record.name) : "");
    uncertain.run = run.record.name;
    auto rows = run.rows({.samples = true,
                          .columns = {"sampling", "label", "number"},
                          .quantities = {x},
                          .values = {shown.value},
                          .directions = directions,
                          .samplings = samplings});
    while (rows.next()) {
        const auto at = series.find(rows.text(0));
        const DrawnAs drawn = judged ? drawn_as(rows.text(1)) : DrawnAs::attractor;
        if (at == series.end() || rows.is_null(4) || drawn == DrawnAs::nothing)
            continue;
        FigureSeries& target = drawn == DrawnAs::attractor ? panel.series[at->second] : uncertain;
        target.add({rows.number(3), rows.number(4)}, static_cast<std::size_t>(rows.integer(2)));
    }
    if (!uncertain.points.empty())
        panel.series.push_back(std::move(uncertain));
    const std::string note = note_of_left_out(run, directions);
    if (!note.empty())
        panel.notes.push_back(named_with(note, over ? shown_name(picture, run.record.name) : ""));
    for (std::size_t s = before; over && s < before + samplings.size(); ++s)
        if (panel.series[s].points.size() > most_overlaid_circles)
            mark_by_crosses(panel.series[s], s - before);
}

/// Range of a run's first coordinate; for measured records with a margin, so that no point lies on the frame.
std::optional<std::pair<double, double>> shown_extent(const StoredRun& run) {
    auto extent = run.extent(run.record.coordinates.front().name);
    constexpr double margin = 0.01;
    if (extent && run.record.kind == "record") {
        const double added = margin * (extent->second - extent->first);
        extent = std::pair(extent->first - added, extent->second + added);
    }
    return extent;
}

/// Draws the runs of the key `over` into the panels of the same values.
void add_over(Figure& figure, const StudyPicture& picture, const std::vector<ShownPanel>& shown,
              const ResultFile& file) {
    for (const std::string& name : picture.over) {
        const StoredRun run(file, name, picture.place);
        bool drawn = false;
        for (std::size_t p = 0; p < shown.size(); ++p)
            if (run.has_value(shown[p].value)) {
                FigurePanel& panel = figure.panels[p];
                const std::string x = first_coordinate(picture, run);
                add_samples_of(panel, picture, run, x, shown[p], true);
                if (const auto extent = run.extent(x); extent && panel.x_range && !picture.x_range) {
                    // Noise may move measured points beyond the computed ones: the margin keeps them off the frame.
                    constexpr double margin = 0.01;
                    const double added = margin * (panel.x_range->second - panel.x_range->first);
                    panel.x_range = std::pair(std::min(panel.x_range->first, extent->first - added),
                                              std::max(panel.x_range->second, extent->second + added));
                }
                drawn = true;
            }
        if (!drawn)
            throw InputError(picture.place, fmt::format("run '{}' has none of the values that are drawn", name),
                             fmt::format("it has {}", name_list(run.value_names())));
    }
}

} // namespace

ResultPicture bifurcation_picture(const StudyPicture& picture, const ResultFile& file) {
    Figure figure;
    std::vector<ShownPanel> shown;
    for (const std::string& name : picture.runs) {
        const StoredRun run(file, name, picture.place);
        const std::vector<std::string> values = chosen_values(picture, run);
        require_values(picture, run, values);
        const std::string x = first_coordinate(picture, run);
        const std::vector<std::string> directions =
            picture.directions.empty() ? run.record.directions : picture.directions;
        figure.columns = values.size() > 1 ? values.size() : directions.size();
        for (const std::string& direction : directions)
            for (std::size_t v = 0; v < values.size(); ++v) {
                FigurePanel panel = panel_of(picture, run, x, values[v], v);
                const std::string letter = panel_letter(figure.panels.size());
                panel.title = fmt::format("{} {}", letter,
                                          direction.empty() ? shown_name(picture, name)
                                                            : fmt::format("{} {}", shown_name(picture, x), direction));
                add_samples_of(panel, picture, run, x, {values[v], direction}, false);
                if (!panel.x_range && picture.x.empty())
                    panel.x_range = shown_extent(run);
                if (run.record.is_swept() && picture.x.empty())
                    panel.marks = places_of_change(run, direction);
                panel.marks_title = meaning_of_marks;
                figure.panels.push_back(std::move(panel));
                shown.push_back({values[v], direction});
            }
    }
    add_over(figure, picture, shown, file);
    share_axes(figure);
    return {std::move(figure)};
}

} // namespace graze
