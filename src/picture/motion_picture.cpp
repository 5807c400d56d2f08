#include "base/special_numbers.hpp"
#include "picture/curve.hpp"
#include "picture/picture_kinds.hpp"

#include "graze/study/point_motion.hpp"
#include "graze/study/stored_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace graze {

namespace {

/// @param at the value to which the point is nearest, if the picture chooses one
std::string title_of_motion(const StudyPicture& picture, const StoredRun& run, const PointRecord& point,
                            const std::vector<std::pair<std::string, double>>& at) {
    std::string title = at.empty() ? shown_name(picture, run.record.name)
                                   : shown_value(picture, run, at.front().first, at.front().second);
    if (point.result.label == Label::periodic)
        title += fmt::format(": period {}", point.result.period);
    else if (run.record.kind != "simulate" && run.record.kind != "record")
        title += fmt::format(": {}", name_of(point.result.label));
    return title;
}

/// Reduces the rows of a record to what is visible: a history to the first, least, greatest and last row of each of a
/// thousand parts, a portrait to its last rows.
std::vector<PlanePoint> seen_rows(std::vector<PlanePoint> points, const StudyPicture& picture, bool portrait) {
    constexpr std::size_t parts = 1000, most_of_portrait = 20'000;
    if (portrait) {
        points.erase(points.begin(),
                     points.end() - static_cast<std::ptrdiff_t>(std::min(points.size(), most_of_portrait)));
        return points;
    }
    if (picture.x_range)
        std::erase_if(points, [&](const PlanePoint& point) {
            return point.x < picture.x_range->first || point.x > picture.x_range->second;
        });
    if (points.size() <= 4 * parts)
        return points;
    std::vector<PlanePoint> seen;
    for (std::size_t part = 0; part < parts; ++part) {
        const std::size_t first = part * points.size() / parts, last = (part + 1) * points.size() / parts - 1;
        std::size_t least = first, greatest = first;
        for (std::size_t i = first; i <= last; ++i) {
            least = points[i].y < points[least].y ? i : least;
            greatest = points[i].y > points[greatest].y ? i : greatest;
        }
        for (const std::size_t i : std::set<std::size_t>{first, least, greatest, last})
            seen.push_back(points[i]);
    }
    return seen;
}

/// Lines from just before to just after each jump, if these points of the panel differ.
std::vector<PlanePoint> jumps_of(const DenseMotion& motion, std::size_t value) {
    const std::vector<double>&xs = motion.values[0], &ys = motion.values[value];
    std::vector<PlanePoint> points;
    for (const std::size_t row : motion.begins)
        if (row > 0 && motion.periods[0] == 0 && motion.periods[value] == 0 &&
            (xs[row] != xs[row - 1] || ys[row] != ys[row - 1]))
            points.insert(points.end(), {{xs[row - 1], ys[row - 1]}, {xs[row], ys[row]}, {not_a_number, not_a_number}});
    return points;
}

/// The samplings of a run; none where its settings cannot be read, as of other versions: the picture needs no more of
/// them.
std::vector<Sampling> stored_samplings(const RunRecord& run) {
    try {
        const StudyRun asked = stored_run(run);
        return asked.has_motions() ? asked.motion().samplings : std::vector<Sampling>{};
    } catch (const InputError&) {
        return {};
    }
}

/// Events of which the picture shows the contacts as samples.
std::set<std::size_t> sampled_events(const StudyPicture& picture, const StoredRun& run) {
    std::set<std::size_t> events;
    const std::vector<std::string> shown = shown_samplings(picture, run);
    for (const Sampling& one : stored_samplings(run.record))
        if (std::ranges::find(shown, one.name) != shown.end())
            events.insert(one.events.begin(), one.events.end());
    return events;
}

/// Adds the motions of points to the panels of a figure, one after the other.
class MotionPanels {
public:
    explicit MotionPanels(const StudyPicture& picture) : picture_(&picture), portrait_(picture.kind != "history") {}

    /// @param at the value to which the point is nearest, if the picture chooses one
    void add(const StoredRun& run, const std::vector<std::pair<std::string, double>>& at) {
        const std::vector<std::string> values = chosen_values(*picture_, run);
        const std::string x = !portrait_ ? "t" : picture_->x.empty() ? values.front() : picture_->x;
        const PointRecord point = chosen_point(run, at, picture_->directions, picture_->place);
        if (!shown_.insert({run.record.name, point.number}).second)
            return; // the point is nearest to two of the requested values
        const bool curve =
            picture_->kind != "poincare" && (run.record.kind == "simulate" || point.result.label == Label::periodic);
        std::vector<std::string> names{x};
        for (const std::string& value : values)
            if (!portrait_ || picture_->x.empty() ? value != x : true)
                names.push_back(value);
        if (portrait_ && names.size() < 2)
            throw InputError(picture_->place, fmt::format("run '{}' has only the value '{}'", run.record.name, x),
                             "name two values, one as x and one as y");
        DenseMotion motion;
        if (curve)
            motion = dense_motion(run, point, names, picture_->place, portrait_ ? WhenLong::last : WhenLong::coarser);
        if (curve && !sampled_.contains(run.record.name))
            sampled_[run.record.name] = sampled_events(*picture_, run);
        const std::string title = title_of_motion(*picture_, run, point, at);
        for (std::size_t v = 1; v < names.size(); ++v) {
            FigurePanel& panel = panel_for(run, x, names[v], v - 1, title);
            const std::size_t before = panel.series.size();
            if (curve)
                add_curve(panel, motion, v, title, run.model.time_unit, sampled_.at(run.record.name));
            add_samples(panel, run, point, x, names[v],
                        curve ? FigureSeries::Style::circles : FigureSeries::Style::dots);
            show_point(panel, before, run.record.name, point.number);
        }
        ++colour_;
    }
    /// Draws the following motions into the existing panels.
    void draw_over() { over_ = true; }
    Figure take() {
        figure_.columns = portrait_ && figure_.panels.size() > 1 ? 2 : 1;
        return std::move(figure_);
    }

private:
    /// True when panels have titles; if other runs are drawn over them, the legend names the runs instead.
    bool is_titled() const { return portrait_ && picture_->over.empty(); }
    /// The panel of a value: portraits have a new panel for each point, histories one panel for each value.
    FigurePanel& panel_for(const StoredRun& run, const std::string& x, const std::string& y, std::size_t value,
                           const std::string& title) {
        const std::size_t index = portrait_ && !over_ ? figure_.panels.size() : value;
        if (index >= figure_.panels.size()) {
            figure_.panels.push_back(panel_of(*picture_, run, x, y, value));
            figure_.panels.back().roomy_y = true;
            figure_.panels.back().roomy_x = portrait_;
            if (is_titled())
                figure_.panels.back().title = fmt::format("{} {}", panel_letter(index), title);
        }
        return figure_.panels[index];
    }
    /// @param sampled events whose contacts are drawn as samples, and not marked a second time
    void add_curve(FigurePanel& panel, const DenseMotion& motion, std::size_t value, const std::string& title,
                   const std::string& time_unit, const std::set<std::size_t>& sampled) const {
        constexpr std::size_t most_marked = 2000; // more marks would hide the curve
        const std::size_t colour = portrait_ && !over_ ? 7 : colour_;
        panel.series.push_back(
            {is_titled() ? "" : title, FigureSeries::Style::line, colour, curve_of(motion, 0, value)});
        add_if_drawn(panel, {"jump", FigureSeries::Style::dotted, FigureSeries::black, jumps_of(motion, value)});
        FigureSeries impacts{"impact", FigureSeries::Style::symbols, FigureSeries::black};
        for (std::size_t i = 0; i < motion.impacts.size(); ++i)
            if (const std::size_t row = motion.impacts[i]; !sampled.contains(motion.met[i]))
                impacts.points.push_back({motion.values[0][row], motion.values[value][row]});
        if (impacts.points.size() <= most_marked)
            add_if_drawn(panel, std::move(impacts));
        else
            panel.notes.push_back(fmt::format("{} impacts are not marked", impacts.points.size() / 2));
        if (motion.outcome.ending == Ending::stopped)
            panel.notes.emplace_back("to follow the motion to its end takes too long");
        if (motion.start > 0)
            panel.notes.push_back(
                fmt::format("from t = {:.6g}{}{} on", motion.start, time_unit.empty() ? "" : " ", time_unit));
    }
    void add_samples(FigurePanel& panel, const StoredRun& run, const PointRecord& point, const std::string& x,
                     const std::string& y, FigureSeries::Style style) const {
        const auto samplings = shown_samplings(*picture_, run), rows = row_samplings(run);
        std::size_t points = 0; // number of samplings drawn as circles, which have their own colours
        for (std::size_t s = 0; s < samplings.size(); ++s) {
            std::vector<double> times;
            const auto ys = samples_of(point, run, y, samplings[s], &times);
            const auto xs = portrait_ ? samples_of(point, run, x, samplings[s], nullptr) : times;
            const bool is_record = std::find(rows.begin(), rows.end(), samplings[s]) != rows.end();
            const bool is_line = is_record && !over_; // measured rows drawn over a curve are dots
            const bool is_point = run.record.kind == "record" && !is_record;
            FigureSeries series{is_record               ? shown_name(*picture_, run.record.name)
                                : portrait_ || is_point ? shown_name(*picture_, samplings[s])
                                                        : "",
                                is_line     ? FigureSeries::Style::line
                                : is_record ? FigureSeries::Style::dots
                                : is_point  ? FigureSeries::Style::circles
                                            : style,
                                portrait_ && !over_ ? is_line ? 7 : points
                                : is_point          ? colour_ + 1 + points
                                                    : colour_};
            points += is_record ? 0 : 1;
            for (std::size_t i = 0; i < std::min(xs.size(), ys.size()); ++i)
                series.points.push_back({xs[i], ys[i]});
            if (is_record)
                series.points = seen_rows(std::move(series.points), *picture_, portrait_);
            // Circles on the lines of a history have the colours of the lines; the legend explains them once.
            const bool on_line = !portrait_ && run.record.kind != "record" && !series.points.empty();
            panel.series.push_back(std::move(series));
            if (on_line)
                panel.series.push_back({.title = shown_name(*picture_, samplings[s]),
                                        .style = style,
                                        .colour = FigureSeries::black,
                                        .only_in_legend = true});
        }
    }

    const StudyPicture* picture_;
    bool portrait_, over_ = false;
    std::map<std::string, std::set<std::size_t>> sampled_; ///< by runs: events that are drawn as samples
    std::set<std::pair<std::string, std::size_t>> shown_;  ///< runs and points that are drawn already
    Figure figure_;
    std::size_t colour_ = 0;
};

} // namespace

ResultPicture motion_picture(const StudyPicture& picture, const ResultFile& file) {
    MotionPanels panels(picture);
    const auto add = [&](const std::vector<std::string>& names) {
        for (const std::string& name : names) {
            const StoredRun run(file, name, picture.place);
            if (picture.at.empty())
                panels.add(run, {});
            for (const auto& at : picture.at)
                panels.add(run, {at});
        }
    };
    add(picture.runs);
    panels.draw_over();
    add(picture.over);
    return {panels.take()};
}

} // namespace graze
