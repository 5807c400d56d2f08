#include "picture/branch_lines.hpp"

#include "base/special_numbers.hpp"
#include "graze/orbit/signature.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/symbolic/parser.hpp"
#include "picture/picture_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace graze {

namespace {

constexpr std::array<std::pair<Look, const char*>, 3> names_of_looks{
    {{Look::stable, "stable"}, {Look::unstable, "unstable"}, {Look::unphysical, "unphysical"}}};

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

/// @throws InputError for parts that the run does not have
void require_parts(const StoredRun& run, const StudyPicture& picture) {
    const std::vector<std::string> known = run.parts();
    for (const std::string& part : picture.directions)
        if (std::find(known.begin(), known.end(), part) == known.end())
            throw InputError(picture.place, fmt::format("run '{}' has no direction '{}'", run.record.name, part),
                             name_advice(part, known, "it has none"));
}

/// Rank of a label when not all fit, the lowest first: points at which the model's motions change, then others; among
/// these, points from which other branches start come first. Labels of inadmissible orbits come last.
int rank_of(const DrawnPoint& point) {
    const PointKind& kind = kind_of(point.type);
    return (point.look == Look::unphysical ? 4 : 0) + (kind.changes || kind.limits ? 0 : 2) +
           (kind.has_bifurcating_branch ? 0 : 1);
}

bool is_rounding(double difference, double size) {
    constexpr double relative = 1e-12;
    return std::abs(difference) <= relative * std::abs(size);
}

/// A stretch of a branch with one look; its end points belong to the adjacent stretches too.
struct Stretch {
    Look look;
    std::vector<std::size_t> points;
};

/// True when a torus is the first one beyond a tongue, of whose orbits the ends are listed before it, that takes more
/// than half of the way from the torus before: in between there are none to draw a line through.
bool is_beyond_wide_tongue(const std::vector<DrawnPoint>& points, std::size_t at) {
    std::size_t first = at;
    while (first > 0 && points[first - 1].type == PointType::locking)
        --first;
    return first > 0 && first < at &&
           std::abs(points[at - 1].x - points[first].x) > 0.5 * std::abs(points[at].x - points[first - 1].x);
}

/// The stretches of all parts of a branch, one after the other. At a special point stability is decided by rounding
/// errors; so the look is that of the adjacent ordinary points, and changes at the first special point between
/// different ones.
std::vector<Stretch> stretches_of(const DrawnBranch& branch) {
    const std::vector<DrawnPoint>& points = branch.points;
    // On a curve of bifurcations one multiplier is always 1 or -1: stability is not shown.
    const auto look_of = [&](std::size_t at) {
        return branch.kept && points[at].look == Look::unstable ? Look::stable : points[at].look;
    };
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
        Look look = look_of(first < end ? first : i);
        stretches.push_back({look, {}});
        for (std::size_t k = i; k < end; ++k) {
            if (points[k].type == PointType::locking) // an orbit beside the tori
                continue;
            if (is_beyond_wide_tongue(points, k))
                stretches.push_back({look, {}});
            stretches.back().points.push_back(k);
            const std::size_t next = next_ordinary(k);
            const Look coming = look_of(next < end ? next : k);
            if (coming != look && k + 1 < end) {
                look = coming;
                stretches.push_back({look, {k}});
            }
        }
        i = end;
    }
    return stretches;
}

} // namespace

bool is_marked(const StudyPicture& picture, const DrawnPoint& point) {
    const auto names = [&](std::string_view name) {
        return std::find(picture.points.begin(), picture.points.end(), name) != picture.points.end();
    };
    return kind_of(point.type).mark != 0 && !point.left_out &&
           (picture.points.empty() || names(short_name(point.type)) || names(point.label) || names(point.name));
}

FigureSeries::Style style_of(PointType kept) {
    return kept == PointType::grazing ? FigureSeries::Style::line
           : kept == PointType::fold  ? FigureSeries::Style::dashed
                                      : FigureSeries::Style::dotted;
}

FigureSeries::Style style_of(Look look) {
    return look == Look::unstable ? FigureSeries::Style::dashed : FigureSeries::Style::line;
}

std::vector<DrawnPoint> drawn_points(const StoredRun& run, const StudyPicture& picture, const std::string& x,
                                     const std::vector<std::string>& values) {
    std::vector<std::string> drawn{x};
    drawn.insert(drawn.end(), values.begin(), values.end());
    for (const std::string& name : drawn)
        require_known(picture, run, name);
    require_parts(run, picture);
    auto rows = run.rows(
        {.columns = {"part", "label", "type", "stable", "admissible", "step", "arclength", "number", "signature"},
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
                          number(9),
                          {}});
        // An equilibrium has no period; a line at 0 would look like one.
        const bool rests = rows.text(8) == rest_name();
        for (std::size_t v = 0; v < values.size(); ++v)
            points.back().y.push_back(rests && values[v] == "period" ? not_a_number : number(10 + v));
    }
    return points;
}

void add_lines(FigurePanel& panel, const DrawnBranch& branch, std::size_t value) {
    const std::vector<DrawnPoint>& points = branch.points;
    if (branch.apart)
        return;
    const std::vector<Stretch> stretches = stretches_of(branch);
    // Unphysical stretches are drawn first, below the others.
    for (const bool unphysical : {true, false})
        for (const Stretch& stretch : stretches) {
            if ((stretch.look == Look::unphysical) != unphysical || stretch.points.size() < 2)
                continue;
            FigureSeries series{"", branch.kept ? style_of(*branch.kept) : style_of(stretch.look),
                                unphysical ? FigureSeries::grey : branch.colour};
            series.run = branch.run;
            for (const std::size_t at : stretch.points) {
                if (kind_of(points[at].type)
                        .limits) // the segment with the greatest value changes there: the line has a corner
                    series.corners.push_back(series.points.size());
                // So does one on which two points lie, whose distance is round-off and has no direction.
                if (!series.along.empty() && is_rounding(points[at].along - series.along.back(), points[at].along))
                    series.corners.insert(series.corners.end(), {series.points.size() - 1, series.points.size()});
                series.add({points[at].x, points[at].y[value]}, points[at].number);
                series.along.push_back(points[at].along);
            }
            panel.series.push_back(std::move(series));
        }
}

void add_symbols(FigurePanel& panel, const StudyPicture& picture, const DrawnBranch& branch, std::size_t value,
                 bool labelled) {
    const std::size_t letters = branch.owner.empty() ? FigureSeries::black : branch.colour;
    std::set<int> symbols;
    for (const DrawnPoint& point : branch.points)
        if (is_marked(picture, point))
            symbols.insert(kind_of(point.type).mark);
    for (const int symbol : symbols) {
        FigureSeries series{.style = FigureSeries::Style::symbols, .colour = branch.colour, .symbol = symbol};
        series.run = branch.run;
        for (const DrawnPoint& point : branch.points)
            if (kind_of(point.type).mark == symbol && is_marked(picture, point)) {
                const PlanePoint here{point.x, point.y[value]};
                series.add(here, point.number);
                if (labelled)
                    panel.labels.push_back(
                        {here, point.name, letters, rank_of(point), branch.owner, branch.run, point.number});
            }
        panel.series.push_back(std::move(series));
    }
    if (branch.points.size() == 1 || branch.apart) {
        FigureSeries& series = panel.series.emplace_back(FigureSeries{"", FigureSeries::Style::circles, branch.colour});
        series.run = branch.run;
        for (const DrawnPoint& point : branch.points)
            series.add({point.x, point.y[value]}, point.number);
    }
}

void add_to_legend(FigurePanel& panel, const std::string& title, FigureSeries::Style style, std::size_t colour,
                   int symbol) {
    panel.series.push_back(
        {.title = title, .style = style, .colour = colour, .symbol = symbol, .only_in_legend = true});
}

void add_looks(FigurePanel& panel, const std::vector<DrawnBranch>& branches, std::size_t colour) {
    std::set<Look> shown;
    for (const DrawnBranch& branch : branches)
        for (const Stretch& stretch : stretches_of(branch))
            if (stretch.points.size() > 1 && !branch.apart && (!branch.kept || stretch.look == Look::unphysical))
                shown.insert(stretch.look);
    for (const auto& [look, name] : names_of_looks)
        if (shown.contains(look))
            add_to_legend(panel, name, style_of(look), look == Look::unphysical ? FigureSeries::grey : colour);
}

void add_point_types(FigurePanel& panel, const StudyPicture& picture, const std::vector<DrawnBranch>& branches,
                     std::size_t colour) {
    std::set<PointType> types;
    for (const DrawnBranch& branch : branches)
        for (const DrawnPoint& point : branch.points)
            if (is_marked(picture, point))
                types.insert(point.type);
    for (const PointType type : types)
        add_to_legend(panel, fmt::format("{}: {}", short_name(type), name_of(type)), FigureSeries::Style::symbols,
                      colour, kind_of(type).mark);
}

} // namespace graze
