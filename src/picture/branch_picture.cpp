#include "base/special_numbers.hpp"
#include "graze/branch/special_point.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/study/stored_study.hpp"
#include "picture/picture_kinds.hpp"
#include "study/point_limits.hpp"
#include "study/start_point.hpp"

#include "graze/symbolic/parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>

namespace graze {

namespace {

constexpr std::size_t most_panels = 4;

/// The property of an orbit that decides how the branch is drawn there.
enum class Look { stable, unstable, unphysical };
constexpr std::array<std::pair<Look, const char*>, 3> branch_looks{
    {{Look::stable, "stable"}, {Look::unstable, "unstable"}, {Look::unphysical, "unphysical"}}};

struct DrawnPoint {
    std::size_t number; ///< of the stored point
    std::string part, label;
    std::string name; ///< text that is shown for the label
    PointType type;
    Look look;
    std::int64_t step;
    double along; ///< arclength along the branch
    double x;
    std::vector<double> y;
};

/// The style of a curve depends on its type: touches are solid, folds dashed, others dotted.
FigureSeries::Style style_of(PointType kept) {
    return kept == PointType::grazing ? FigureSeries::Style::line
           : kept == PointType::fold  ? FigureSeries::Style::dashed
                                      : FigureSeries::Style::dotted;
}

FigureSeries::Style style_of(Look look) {
    return look == Look::unstable ? FigureSeries::Style::dashed : FigureSeries::Style::line;
}

/// Names of the values of a branch that can be drawn, besides expressions in SQL.
std::vector<std::string> known_names(const StoredRun& run) {
    std::vector<std::string> names{"multiplier"};
    for (const auto& list : {run.value_names(), run.coordinate_names(), run.number_columns()})
        names.insert(names.end(), list.begin(), list.end());
    return names;
}

void require_known(const StudyPicture& picture, const StoredRun& run, const std::string& name) {
    const std::vector<std::string> known = known_names(run);
    if (is_valid_name(name) && std::find(known.begin(), known.end(), name) == known.end())
        throw InputError(picture.place, fmt::format("run '{}' has no monitor or parameter '{}'", run.record.name, name),
                         name_advice(name, known, ""));
}

/// The type of points that a curve follows, from the point where it starts; none: the run is a branch.
std::optional<PointType> kept_of(const StoredRun& run) {
    if (run.record.kind != name_of(RunKind::curve))
        return std::nullopt;
    const StudyRun asked = stored_run(run.record);
    if (asked.start && point_type(asked.start->onto))
        return point_type(asked.start->onto);
    const auto parent = asked.start ? run.file.find_run(asked.start->run) : std::nullopt;
    return parent ? orbit_to_start_from(*asked.start, stored_run(*parent), run.file).point.type : PointType::regular;
}

/// Monitors of the first run that all runs have, or the period; for a curve its second parameter.
std::vector<std::string> default_values(const std::vector<StoredRun>& runs) {
    std::vector<std::string> names;
    if (runs.front().record.kind == name_of(RunKind::curve))
        return {runs.front().record.coordinates.at(1).name};
    for (const ResultColumn& column : runs.front().record.values)
        if (names.size() < most_panels &&
            std::all_of(runs.begin(), runs.end(), [&](const StoredRun& run) { return run.has_value(column.name); }))
            names.push_back(column.name);
    return names.empty() ? std::vector<std::string>{"period"} : names;
}

/// @throws InputError for parts that the run does not have
void require_parts(const StoredRun& run, const StudyPicture& picture) {
    const std::vector<std::string> known = run.parts();
    for (const std::string& part : picture.directions)
        if (std::find(known.begin(), known.end(), part) == known.end())
            throw InputError(picture.place, fmt::format("run '{}' has no direction '{}'", run.record.name, part),
                             name_advice(part, known, "it has none"));
}

std::vector<DrawnPoint> points_of(const StoredRun& run, const StudyPicture& picture, const std::string& x,
                                  const std::vector<std::string>& values) {
    std::vector<std::string> drawn{x};
    drawn.insert(drawn.end(), values.begin(), values.end());
    for (const std::string& name : drawn)
        require_known(picture, run, name);
    require_parts(run, picture);
    auto rows = run.rows({.columns = {"part", "label", "type", "stable", "admissible", "step", "arclength", "number"},
                          .quantities = drawn,
                          .directions = picture.directions});
    std::vector<DrawnPoint> points;
    while (rows.next()) {
        const auto number = [&](std::size_t column) { // infinite values cannot be drawn
            return rows.is_null(column) || std::isinf(rows.number(column)) ? not_a_number : rows.number(column);
        };
        points.push_back({static_cast<std::size_t>(rows.integer(7)),
                          rows.text(0),
                          rows.text(1),
                          run.record.point_name(rows.text(1)),
                          point_type(rows.text(2)).value_or(PointType::regular),
                          rows.integer(4) == 0   ? Look::unphysical
                          : rows.integer(3) == 0 ? Look::unstable
                                                 : Look::stable,
                          rows.integer(5),
                          number(6),
                          number(8),
                          {}});
        for (std::size_t v = 0; v < values.size(); ++v)
            points.back().y.push_back(number(9 + v));
    }
    return points;
}

/// A stretch of a branch with one look; its end points belong to the adjacent stretches too.
struct Stretch {
    Look look;
    std::vector<std::size_t> points;
};

/// The stretches of all parts of a branch, one after the other. At a special point stability is decided by rounding
/// errors; so the look is that of the adjacent ordinary points, and changes at the first special point between
/// different ones.
std::vector<Stretch> stretches_of(const std::vector<DrawnPoint>& points) {
    std::vector<Stretch> stretches;
    for (std::size_t i = 0; i < points.size();) {
        std::size_t end = i + 1; // two parts may have the same name, but the number of steps begins again
        while (end < points.size() && points[end].part == points[i].part && points[end].step >= points[end - 1].step)
            ++end;
        const auto next_ordinary = [&](std::size_t at) {
            while (at < end && kind_of(points[at].type).changes)
                ++at;
            return at;
        };
        const std::size_t first = next_ordinary(i);
        Look look = points[first < end ? first : i].look;
        stretches.push_back({look, {i}});
        for (std::size_t k = i + 1; k < end; ++k) {
            stretches.back().points.push_back(k);
            const std::size_t next = next_ordinary(k);
            const Look coming = next < end ? points[next].look : points[k].look;
            if (coming != look && k + 1 < end) {
                look = coming;
                stretches.push_back({look, {k}});
            }
        }
        i = end;
    }
    return stretches;
}

/// Rank of a label when not all fit, the lowest first: points at which the model's motions change, then others; among
/// these, points from which other branches start come first. Labels of inadmissible orbits come last.
int rank_of(const DrawnPoint& point) {
    const PointKind& kind = kind_of(point.type);
    return (point.look == Look::unphysical ? 4 : 0) + (kind.changes || kind.limits ? 0 : 2) +
           (kind.has_bifurcating_branch ? 0 : 1);
}

/// True for points that are marked: all whose type has a symbol, unless the picture chooses types or labels.
bool is_marked(const StudyPicture& picture, const DrawnPoint& point) {
    const auto names = [&](std::string_view name) {
        return std::find(picture.points.begin(), picture.points.end(), name) != picture.points.end();
    };
    return kind_of(point.type).mark != 0 &&
           (picture.points.empty() || names(short_name(point.type)) || names(point.label) || names(point.name));
}

/// Adds the lines, symbols and labels of a branch or curve to a panel.
/// @param kept type of the curve; none: a branch, whose line style shows stability
/// @param owner name of the branch if there are several; empty: its labels are black
void add_branch(FigurePanel& panel, const StudyPicture& picture, const std::string& run,
                const std::vector<DrawnPoint>& points, const std::optional<PointType>& kept, std::size_t value,
                std::size_t colour, const std::string& owner) {
    const std::size_t labels = owner.empty() ? FigureSeries::black : colour;
    // Unphysical stretches are drawn first, below the others.
    const std::vector<Stretch> stretches = stretches_of(points);
    for (const bool unphysical : {true, false})
        for (const Stretch& stretch : stretches) {
            if ((stretch.look == Look::unphysical) != unphysical || stretch.points.size() < 2)
                continue;
            FigureSeries series{"", kept ? style_of(*kept) : style_of(stretch.look),
                                unphysical ? FigureSeries::grey : colour};
            series.run = run;
            for (const std::size_t at : stretch.points) {
                if (kind_of(points[at].type)
                        .limits) // the segment with the greatest value changes there: the line has a corner
                    series.corners.push_back(series.points.size());
                series.add({points[at].x, points[at].y[value]}, points[at].number);
                series.along.push_back(points[at].along);
            }
            panel.series.push_back(std::move(series));
        }
    std::set<int> symbols;
    for (const DrawnPoint& point : points)
        if (is_marked(picture, point))
            symbols.insert(kind_of(point.type).mark);
    for (const int symbol : symbols) {
        FigureSeries series{.style = FigureSeries::Style::symbols, .colour = colour, .symbol = symbol, .run = run};
        for (const DrawnPoint& point : points)
            if (kind_of(point.type).mark == symbol && is_marked(picture, point)) {
                const PlanePoint here{point.x, point.y[value]};
                series.add(here, point.number);
                panel.labels.push_back({here, point.name, labels, rank_of(point), owner, run, point.number});
            }
        panel.series.push_back(std::move(series));
    }
    if (points.size() == 1) {
        FigureSeries& series = panel.series.emplace_back(FigureSeries{"", FigureSeries::Style::circles, colour});
        series.run = run;
        series.add({points[0].x, points[0].y[value]}, points[0].number);
    }
}

/// Colours of the runs; runs with the same shown name have the same colour.
std::vector<std::size_t> colours_of(const StudyPicture& picture, const std::vector<StoredRun>& runs) {
    std::map<std::string, std::size_t> known;
    std::vector<std::size_t> colours;
    for (const StoredRun& run : runs)
        colours.push_back(known.try_emplace(shown_name(picture, run.record.name), known.size()).first->second);
    return colours;
}

/// Meanings of the line styles of curves; empty if each style belongs to one run, whose name tells it.
std::map<FigureSeries::Style, std::string> curve_styles(const std::vector<std::optional<PointType>>& kept) {
    std::set<PointType> types;
    for (const std::optional<PointType>& type : kept)
        if (type)
            types.insert(*type);
    std::map<FigureSeries::Style, std::string> meanings;
    if (types.size() < 2 || types.size() == kept.size())
        return meanings;
    for (const PointType type : types) {
        std::string& meaning = meanings[style_of(type)];
        meaning += (meaning.empty() ? "" : ", ") + std::string(kind_of(type).name);
    }
    return meanings;
}

/// Adds the colours of the runs and the meanings of the used styles and symbols to the legend.
void add_legend(FigurePanel& panel, const StudyPicture& picture, const std::vector<StoredRun>& runs,
                const std::vector<std::vector<DrawnPoint>>& points, const std::vector<std::optional<PointType>>& kept) {
    const std::vector<std::size_t> colours = colours_of(picture, runs);
    const auto add = [&](const std::string& title, FigureSeries::Style style, std::size_t colour, int symbol = 0) {
        panel.series.push_back(
            {.title = title, .style = style, .colour = colour, .symbol = symbol, .only_in_legend = true});
    };
    if (runs.size() > 1)
        for (std::size_t r = 0; r < runs.size(); ++r)
            if (!points[r].empty())
                add(shown_name(picture, runs[r].record.name), kept[r] ? style_of(*kept[r]) : FigureSeries::Style::line,
                    colours[r]);
    for (const auto& [style, meaning] : curve_styles(kept))
        add(meaning, style, FigureSeries::black);
    std::set<Look> shown;
    for (std::size_t r = 0; r < runs.size(); ++r)
        for (const Stretch& stretch : stretches_of(points[r]))
            if (stretch.points.size() > 1 && (!kept[r] || stretch.look == Look::unphysical))
                shown.insert(stretch.look);
    const std::size_t colour = runs.size() > 1 ? FigureSeries::black : 0;
    for (const auto& [look, name] : branch_looks)
        if (shown.contains(look))
            add(name, style_of(look), look == Look::unphysical ? FigureSeries::grey : colour);
    std::set<PointType> types;
    for (const std::vector<DrawnPoint>& of_run : points)
        for (const DrawnPoint& point : of_run)
            if (is_marked(picture, point))
                types.insert(point.type);
    for (const PointType type : types)
        add(fmt::format("{}: {}", kind_of(type).short_name, kind_of(type).name), FigureSeries::Style::symbols, colour,
            kind_of(type).mark);
}

} // namespace

ResultPicture branch_picture(const StudyPicture& picture, const ResultFile& file) {
    std::vector<StoredRun> runs;
    for (const std::string& name : picture.runs) {
        const StoredRun& run = runs.emplace_back(file, name, picture.place);
        if (!run.record.is_branch())
            throw InputError(picture.place, fmt::format("run '{}' is of kind {}, not a branch", name, run.record.kind),
                             "leave the kind of picture out to have it drawn by its own kind");
    }
    const std::string x = picture.x.empty() ? first_coordinate(picture, runs.front()) : picture.x;
    const std::vector<std::string> values = picture.y.empty() ? default_values(runs) : picture.y;
    std::vector<std::vector<DrawnPoint>> points;
    std::vector<std::optional<PointType>> kept;
    for (const StoredRun& run : runs) {
        points.push_back(points_of(run, picture, x, values));
        kept.push_back(kept_of(run));
        // On a curve of bifurcations one multiplier is always 1 or -1: stability is not shown.
        for (DrawnPoint& point : points.back())
            if (kept.back() && point.look == Look::unstable)
                point.look = Look::stable;
    }
    Figure figure;
    figure.columns = values.size() > 1 ? 2 : 1;
    for (std::size_t v = 0; v < values.size(); ++v) {
        FigurePanel panel = panel_of(picture, runs.front(), x, values[v], v);
        panel.roomy_y = true;
        if (values.size() > 1 || runs.size() == 1)
            panel.title = (values.size() > 1 ? panel_letter(v) + " " : std::string()) +
                          (runs.size() == 1 ? shown_name(picture, runs.front().record.name) : std::string());
        const std::vector<std::size_t> colours = colours_of(picture, runs);
        for (std::size_t r = 0; r < runs.size(); ++r)
            add_branch(panel, picture, runs[r].record.name, points[r], kept[r], v, colours[r],
                       runs.size() > 1 ? shown_name(picture, runs[r].record.name) : "");
        add_legend(panel, picture, runs, points, kept);
        figure.panels.push_back(std::move(panel));
    }
    return {std::move(figure)};
}

} // namespace graze
