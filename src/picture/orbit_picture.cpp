#include "base/special_numbers.hpp"
#include "graze/orbit/signature.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/orbit_motion.hpp"
#include "graze/results/quantity_evaluator.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/study/plain_states.hpp"
#include "graze/symbolic/function.hpp"
#include "picture/box.hpp"
#include "picture/curve.hpp"
#include "picture/picture_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr std::size_t drawn_samples = 2000, most_default_orbits = 6;
constexpr PlanePoint interruption{not_a_number, not_a_number};

std::size_t nearest_number(const StoredRun& run, const StudyPicture& picture,
                           const std::pair<std::string, double>& at) {
    const std::vector<std::string> known = run.coordinate_names();
    if (std::find(known.begin(), known.end(), at.first) == known.end())
        throw InputError(picture.place, fmt::format("run '{}' has no parameter '{}'", run.record.name, at.first),
                         name_advice(at.first, known, "it has none"));
    const auto number = run.nearest({at}, picture.directions);
    if (!number)
        throw InputError(picture.place, fmt::format("run '{}' has no such orbit", run.record.name),
                         "run the study first, or choose another direction");
    return *number;
}

/// The orbits that the picture chooses, or the first few special points.
std::vector<OrbitRecord> shown_orbits(const ResultFile& file, const StoredRun& run, const StudyPicture& picture) {
    std::vector<OrbitRecord> orbits;
    for (const std::string& point : picture.points)
        orbits.push_back(orbit_of_run(file, run.record, point, picture.place));
    for (const auto& at : picture.at)
        orbits.push_back(*file.orbit(run.record.name, nearest_number(run, picture, at)));
    if (!orbits.empty())
        return orbits;
    for (OrbitRecord& record : file.orbits(run.record.name, true))
        if (record.point.type != PointType::end && record.point.type != PointType::bound &&
            orbits.size() < most_default_orbits)
            orbits.push_back(std::move(record));
    if (orbits.empty())
        orbits = file.orbits(run.record.name, false);
    if (orbits.empty())
        throw InputError(picture.place, fmt::format("run '{}' has no orbits yet", run.record.name),
                         "run the study first");
    if (run.record.is_followed() && orbits.front().point.type == PointType::end)
        orbits.erase(orbits.begin(), orbits.end() - 1);
    return orbits;
}

/// The values on the axes; the first is x unless time is.
struct Axes {
    std::vector<NamedValue> values;
    std::vector<double> periods; ///< periods of cyclic states, at which lines are interrupted; 0 for others
    bool over_time = false;
};

Axes axes_of(const Model& model, const StudyPicture& picture) {
    Axes axes;
    std::vector<std::string> names = picture.y, pair = default_portrait(model);
    axes.over_time =
        picture.kind != "portrait" || picture.x == "t" || (picture.x.empty() && names.empty() && pair.empty());
    if (names.empty() && axes.over_time)
        names = plain_states(model);
    else if (names.empty() && !pair.empty())
        names = {picture.x == pair[1] ? pair[0] : pair[1]};
    if (names.empty())
        throw InputError(picture.place, "nothing says what to draw", "name states or expressions");
    if (!axes.over_time)
        names.insert(names.begin(), !picture.x.empty() ? picture.x : pair.empty() ? model.states[0].name : pair[0]);
    for (const std::string& name : names) {
        axes.values.push_back(named_value(model, name, picture.place));
        const auto state = model.find_state(name);
        const bool cyclic = state && model.states[*state].period;
        axes.periods.push_back(cyclic ? model.periods()[*state] : 0);
    }
    return axes;
}

/// An orbit's motion, and its values on the axes.
struct DrawnOrbit {
    std::string run; ///< to which it belongs
    OrbitRecord record;
    std::vector<SegmentMotion> motion;
    std::vector<std::vector<std::vector<double>>> values; ///< [segment][value][row]
    Model model;
    Axes axes;
};

DrawnOrbit drawn_orbit(const StoredRun& run, OrbitRecord record, const StudyPicture& picture) {
    const Orbit orbit = whole_orbit(System(run.model), record.point.solution.orbit);
    DrawnOrbit drawn{run.record.name,
                     std::move(record),
                     orbit_motion(run.model, orbit, drawn_samples),
                     {},
                     model_at(run.model, orbit),
                     {}};
    drawn.axes = axes_of(drawn.model, picture);
    QuantityEvaluator evaluate(drawn.model, drawn.axes.values);
    for (const SegmentMotion& segment : drawn.motion) {
        auto& columns = drawn.values.emplace_back(drawn.axes.values.size());
        for (const std::vector<double>& state : segment.states) {
            const std::span<const double> row = evaluate(state);
            for (std::size_t v = 0; v < row.size(); ++v)
                columns[v].push_back(row[v]);
        }
    }
    return drawn;
}

/// The curves of one panel: a value over time, or over the first value.
class OrbitCurves {
public:
    OrbitCurves(const DrawnOrbit& orbit, std::size_t value) : orbit_(orbit), value_(value) {}

    PlanePoint at(std::size_t segment, std::size_t row) const {
        const auto& columns = orbit_.values[segment];
        return {orbit_.axes.over_time ? orbit_.motion[segment].times[row] : columns[0][row], columns[value_][row]};
    }
    std::vector<PlanePoint> line(std::size_t segment) const {
        std::vector<PlanePoint> points;
        for (std::size_t row = 0; row < orbit_.motion[segment].times.size(); ++row) {
            const PlanePoint here = at(segment, row);
            if (!points.empty() && is_interrupted(points.back(), here))
                points.push_back(interruption);
            points.push_back(here);
        }
        return points;
    }
    /// Lines from the end of each segment to the start of the next, if they differ by more than the orbit's error.
    std::vector<PlanePoint> jumps() const {
        constexpr double unseen = 1e-5;
        std::vector<PlanePoint> points;
        const std::size_t count = orbit_.motion.size();
        const PlanePoint size = extent();
        for (std::size_t s = 0; s < count; ++s) {
            const std::size_t next = (s + 1) % count;
            if ((orbit_.axes.over_time && next == 0) || orbit_.motion[s].times.empty() ||
                orbit_.motion[next].times.empty())
                continue;
            const PlanePoint before = at(s, orbit_.motion[s].times.size() - 1), after = at(next, 0);
            const bool seen =
                std::abs(after.x - before.x) > unseen * size.x || std::abs(after.y - before.y) > unseen * size.y;
            if (seen && !is_interrupted(before, after))
                points.insert(points.end(), {before, after, interruption});
        }
        return points;
    }
    /// End points of the segments that end at an event, not at a section.
    std::vector<PlanePoint> events(const Signature& signature) const {
        std::vector<PlanePoint> points;
        for (std::size_t s = 0; s < std::min(signature.size(), orbit_.motion.size()); ++s)
            if (ends_by_transition(signature[s]) && !orbit_.motion[s].times.empty())
                points.push_back(at(s, orbit_.motion[s].times.size() - 1));
        return points;
    }
    /// The row of a segment nearest to a time since its start.
    PlanePoint at_time(std::size_t segment, double since) const {
        const std::vector<double>& times = orbit_.motion[segment].times;
        std::size_t best = 0;
        for (std::size_t row = 0; row < times.size(); ++row)
            if (std::abs(times[row] - times[0] - since) < std::abs(times[best] - times[0] - since))
                best = row;
        return at(segment, best);
    }

private:
    /// Ranges of the curves in x and y.
    PlanePoint extent() const {
        Extent x, y;
        for (std::size_t s = 0; s < orbit_.motion.size(); ++s)
            for (std::size_t row = 0; row < orbit_.motion[s].times.size(); ++row) {
                const PlanePoint here = at(s, row);
                x.add(here.x);
                y.add(here.y);
            }
        return {x.greatest - x.least, y.greatest - y.least};
    }
    bool is_interrupted(const PlanePoint& a, const PlanePoint& b) const {
        const std::vector<double>& periods = orbit_.axes.periods;
        return wraps_around(a.y, b.y, periods[value_]) ||
               (!orbit_.axes.over_time && wraps_around(a.x, b.x, periods[0]));
    }
    const DrawnOrbit& orbit_;
    std::size_t value_;
};

/// True for runs whose orbits are not those of a branch.
bool stands_alone(const RunRecord& run) {
    return run.is_branch() && !run.is_followed();
}

std::string title_with_parameter(const StudyPicture& picture, const StoredRun& run, const OrbitRecord& record) {
    std::string title = stands_alone(run.record) ? shown_name(picture, run.record.name)
                        : record.label.empty()   ? title_of(record)
                                                 : run.record.point_name(record.label);
    if (const std::string followed = followed_parameter(run.record); !followed.empty())
        title += fmt::format(": {} = {:.6g}{}{}", shown_name(picture, followed), record.point.parameter,
                             run.unit(followed).empty() ? "" : " ", run.unit(followed));
    if (is_unphysical(record))
        title += " (unphysical)";
    return title;
}

/// The end of a segment in the legend. The name of a transition without label is MODE:EVENT, of which EVENT is shown.
std::string shown_end(const StudyPicture& picture, const DrawnOrbit& orbit, std::size_t segment) {
    const std::string& end = orbit.motion[segment].end;
    const std::string mode = orbit.model.modes[orbit.motion[segment].mode].name + ":";
    const bool given = shown_name(picture, end) != shown_name({}, end);
    return shown_name(picture, !given && end.starts_with(mode) ? end.substr(mode.size()) : end);
}

/// Adds the curves of an orbit to a panel.
/// @param colour colour of all segments; none: one for each segment, the same in both halves of a symmetric orbit
void add_curves(FigurePanel& panel, const StudyPicture& picture, const DrawnOrbit& orbit, std::size_t value,
                std::optional<std::size_t> colour, const std::string& title) {
    const OrbitCurves curves(orbit, value);
    const std::size_t before = panel.series.size();
    constexpr std::size_t most_titles = 8;
    const std::size_t kinds = std::max<std::size_t>(1, orbit.record.point.solution.orbit.segments());
    for (std::size_t s = 0; s < orbit.motion.size(); ++s) {
        std::string name = s == 0 ? title : "";
        if (!colour && kinds <= most_titles && s < kinds)
            name = fmt::format("{} {} → {}", s + 1, shown_name(picture, orbit.model.modes[orbit.motion[s].mode].name),
                               shown_end(picture, orbit, s));
        panel.series.push_back({name, FigureSeries::Style::line, colour.value_or(s % kinds), curves.line(s)});
    }
    add_if_drawn(panel, {"jump", FigureSeries::Style::dotted, FigureSeries::black, curves.jumps()});
    const SpecialPoint& point = orbit.record.point;
    const Signature signature = whole_orbit(System(orbit.model), point.solution.orbit).signature;
    add_if_drawn(panel, {"event", FigureSeries::Style::circles, FigureSeries::black, curves.events(signature)});
    if (point.type == PointType::grazing && !point.at_end && point.segment < orbit.motion.size() &&
        !orbit.motion[point.segment].times.empty()) {
        const PlanePoint touch = curves.at_time(point.segment, point.time);
        panel.series.push_back({"touch", FigureSeries::Style::symbols, FigureSeries::black, {touch}, 12});
        panel.labels.push_back({touch, shown_name(picture, orbit.model.events[point.event].name)});
    }
    show_point(panel, before, orbit.run, orbit.record.number);
}

/// Adds an equilibrium to a panel: a point, filled where it is stable.
/// @param owner what the legend names before the stability; may be empty
void add_rest(FigurePanel& panel, const DrawnOrbit& orbit, std::size_t value, std::size_t colour,
              const std::string& owner) {
    const std::size_t before = panel.series.size();
    const bool unphysical = is_unphysical(orbit.record), stable = orbit.record.stable;
    const std::string look = fmt::format("{} equilibrium{}", stable ? "stable" : "unstable",
                                         unphysical && owner.empty() ? " (unphysical)" : "");
    panel.series.push_back({.title = owner.empty() ? look : owner + ", " + look,
                            .style = FigureSeries::Style::symbols,
                            .colour = unphysical ? FigureSeries::grey : colour,
                            .points = OrbitCurves(orbit, value).line(0),
                            .symbol = stable ? 7 : 6});
    show_point(panel, before, orbit.run, orbit.record.number);
}

FigurePanel history_panel(const StudyPicture& picture, const DrawnOrbit& orbit, std::size_t v) {
    const Axes& axes = orbit.axes;
    const NamedValue time{"t", orbit.model.time_unit, "time", {}};
    FigurePanel panel = empty_panel(picture);
    label_axis(panel.x_label, panel.x_words, panel.x_unit, picture, axes.over_time ? time : axes.values[0]);
    label_axis(panel.y_label, panel.y_words, panel.y_unit, picture, axes.values[v]);
    apply_labels(panel, picture, axes.over_time ? v : v - 1);
    return panel;
}

} // namespace

ResultPicture orbit_picture(const StudyPicture& picture, const ResultFile& file) {
    Figure figure;
    std::vector<DrawnOrbit> orbits;
    std::vector<std::string> titles;
    bool all_alone = true; // all runs consist of a single orbit
    for (const std::string& name : picture.runs) {
        const StoredRun run(file, name, picture.place);
        for (OrbitRecord& record : shown_orbits(file, run, picture)) {
            const std::string title = title_with_parameter(picture, run, record);
            const bool has_name = stands_alone(run.record);
            all_alone = all_alone && has_name;
            titles.push_back(picture.runs.size() > 1 && !has_name ? shown_name(picture, name) + ", " + title : title);
            orbits.push_back(drawn_orbit(run, std::move(record), picture));
        }
    }
    const bool together = all_alone && orbits.size() > 1; // single orbits share one panel, for comparison
    for (std::size_t o = 0; o < orbits.size(); ++o) {
        const DrawnOrbit& orbit = orbits[o];
        const Axes& axes = orbit.axes;
        const bool over_time = axes.over_time;
        for (std::size_t v = over_time ? 0 : 1; v < axes.values.size(); ++v) {
            const std::size_t index = over_time ? v : together ? v - 1 : figure.panels.size();
            if (index >= figure.panels.size()) {
                figure.panels.push_back(history_panel(picture, orbit, v));
                const bool several = orbits.size() > 1;
                if (!several || (!over_time && !together))
                    figure.panels.back().title = (several ? panel_letter(index) + " " : std::string()) + titles[o];
                figure.panels.back().roomy_y = true;
                figure.panels.back().roomy_x = !over_time;
            }
            const bool by_segment = orbits.size() == 1 || (!over_time && !together);
            if (is_rest(orbit.record.point.solution.orbit.signature)) {
                // All equilibria of a run have one colour.
                const auto first = std::ranges::find(orbits, orbit.run, &DrawnOrbit::run) - orbits.begin();
                const bool named = !by_segment && (!together || picture.runs.size() > 1);
                add_rest(figure.panels[index], orbit, v,
                         by_segment ? 0
                         : together ? static_cast<std::size_t>(first)
                                    : o,
                         named ? titles[o] : "");
            } else {
                add_curves(figure.panels[index], picture, orbit, v, by_segment ? std::nullopt : std::optional(o),
                           by_segment ? "" : titles[o]);
            }
        }
    }
    figure.columns = figure.panels.size() > 1 && !orbits.front().axes.over_time ? 2 : 1;
    return {std::move(figure)};
}

} // namespace graze
