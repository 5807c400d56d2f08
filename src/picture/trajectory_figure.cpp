#include "graze/picture/trajectory_figure.hpp"

#include "base/special_numbers.hpp"
#include "picture/box.hpp"
#include "picture/curve.hpp"
#include "picture/shown_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace graze {

namespace {

constexpr double invisible_deviation = 2e-4; ///< greatest deviation of simplified curves, as a fraction of the panel
constexpr double last_moments = 0.005;       ///< final fraction of a motion to a singularity that the axes ignore
constexpr std::size_t most_marked_contacts = 2000; ///< number of contacts; more marks would hide the curve
constexpr std::size_t section_colour = 1;

class TrajectoryPanels {
public:
    explicit TrajectoryPanels(const MotionRecorder& recorder) : recorder_(&recorder) {
        for (std::size_t value = 0; value < motion().values.size(); ++value)
            ranges_.push_back(range_of(value));
    }

    Figure figure() const {
        Figure figure;
        const std::vector<std::size_t> histories = shown_histories();
        const auto& portraits = recorder_->contents().portraits;
        figure.columns = !histories.empty() && !portraits.empty() ? 2 : portraits.size() > 1 ? 2 : 1;
        for (std::size_t i = 0; i < std::max(histories.size(), portraits.size()); ++i) {
            if (i < histories.size())
                figure.panels.push_back(panel(time, 1 + histories[i]));
            if (i < portraits.size()) {
                figure.panels.push_back(panel(1 + portraits[i].first, 1 + portraits[i].second));
                figure.panels.back().rows = rows_of(i, portraits.size(), histories.size());
            }
        }
        if (!recorder_->is_complete() && !figure.panels.empty())
            figure.panels.front().notes.emplace_back("only the beginning of the motion is shown");
        for (const auto& parameter : recorder_->model().parameters)
            figure.symbols.push_back(parameter.name);
        for (const auto& state : recorder_->model().states)
            figure.symbols.push_back(state.name);
        return figure;
    }

private:
    static constexpr std::size_t time = 0; ///< index of the time among the motion's values; columns follow

    const DenseMotion& motion() const { return recorder_->motion(); }

    /// Number of rows of a portrait: portraits share the height of the histories beside them.
    static std::size_t rows_of(std::size_t portrait, std::size_t portraits, std::size_t histories) {
        if (histories <= portraits)
            return 1;
        return (portrait + 1) * histories / portraits - portrait * histories / portraits;
    }

    std::vector<std::size_t> shown_histories() const {
        const MotionPanelChoice& contents = recorder_->contents();
        std::vector<std::size_t> shown;
        for (const std::size_t column : contents.histories)
            if (contents.chosen || !ranges_[1 + column].is_constant())
                shown.push_back(column);
        return shown.empty() ? contents.histories : shown;
    }

    double start() const { return motion().values[time].front(); }
    double end() const { return motion().values[time].back(); }

    Extent range_of(std::size_t value) const {
        Extent range;
        const std::vector<double>&times = motion().values[time], &values = motion().values[value];
        if (times.empty())
            return range;
        const double last = recorder_->singularity() ? end() - last_moments * (end() - start()) : end();
        for (std::size_t i = 0; i < times.size() && times[i] <= last; ++i)
            if (std::isfinite(values[i]))
                range.add(values[i]);
        return range;
    }

    FigurePanel panel(std::size_t x, std::size_t y) const {
        FigurePanel panel;
        label_axis(panel.x_label, panel.x_words, panel.x_unit, {}, shown(x));
        label_axis(panel.y_label, panel.y_words, panel.y_unit, {}, shown(y));
        panel.roomy_y = true;
        panel.roomy_x = x != time;
        if (motion().values[time].empty())
            return panel;
        limit(panel, x, y);
        panel.series.push_back({"", FigureSeries::Style::line, 0, seen_curve(x, y)});
        add_marks(panel, x, y);
        return panel;
    }

    NamedValue shown(std::size_t value) const {
        return value == time ? NamedValue{"t", recorder_->model().time_unit, "time", {}}
                             : recorder_->contents().columns[value - 1];
    }

    void limit(FigurePanel& panel, std::size_t x, std::size_t y) const {
        constexpr double margin = 0.08, after = 0.01;
        const auto roomy = [&](std::size_t value) {
            const Extent& range = ranges_[value];
            const double added = margin * (range.span() > 0 ? range.span() : std::max(std::abs(range.least), 1.0));
            return std::pair(range.least - added, range.greatest + added);
        };
        if (const auto singularity = recorder_->singularity()) {
            panel.y_range = roomy(y);
            if (x == time) {
                panel.x_range = {start(), *singularity + after * (*singularity - start())};
                panel.marks.push_back(*singularity);
                panel.marks_title = "singularity";
            } else {
                panel.x_range = roomy(x);
            }
        } else if (x == time && end() > start()) {
            panel.x_range = {start(), end()};
        }
    }

    /// The curve without points that do not change its appearance, so that drawing is faster.
    std::vector<PlanePoint> seen_curve(std::size_t x, std::size_t y) const {
        const std::vector<PlanePoint> curve = curve_of(motion(), x, y);
        const double width = x == time ? end() - start() : ranges_[x].span(), height = ranges_[y].span();
        if (!(width > 0 && height > 0))
            return curve;
        const auto is_drawn = [](const PlanePoint& point) { return std::isfinite(point.x) && std::isfinite(point.y); };
        std::vector<PlanePoint> seen;
        for (auto begin = curve.begin(); begin != curve.end();) {
            begin = std::find_if(begin, curve.end(), is_drawn);
            const auto end = std::find_if_not(begin, curve.end(), is_drawn);
            const Polyline line = simplified(std::span(begin, end), width, height, invisible_deviation);
            seen.insert(seen.end(), line.begin(), line.end());
            if (end != curve.end())
                seen.push_back(*end);
            begin = end;
        }
        return seen;
    }

    void add_marks(FigurePanel& panel, std::size_t x, std::size_t y) const {
        FigureSeries jumps{"jump", FigureSeries::Style::dotted, FigureSeries::black};
        FigureSeries contacts{"contact", FigureSeries::Style::symbols, FigureSeries::black};
        FigureSeries passages{recorder_->section_names(), FigureSeries::Style::circles, section_colour};
        const bool cyclic = motion().periods[x] > 0 || motion().periods[y] > 0;
        for (const MotionRecorder::Jump& jump : recorder_->jumps()) {
            const PlanePoint before{jump.before[x], jump.before[y]}, after{jump.after[x], jump.after[y]};
            const bool moves = before.x != after.x || before.y != after.y;
            if (moves && !cyclic)
                jumps.points.insert(jumps.points.end(), {before, after, {not_a_number, not_a_number}});
            if (jump.marked)
                contacts.points.push_back(before);
            if (jump.marked && moves)
                contacts.points.push_back(after);
        }
        for (const MotionRecorder::Row& passage : recorder_->passages())
            passages.points.push_back({passage[x], passage[y]});
        if (contacts.points.size() > most_marked_contacts) {
            const auto count = std::count_if(recorder_->jumps().begin(), recorder_->jumps().end(),
                                             [](const MotionRecorder::Jump& jump) { return jump.marked; });
            panel.notes.push_back(fmt::format("{} contacts are not marked", count));
            contacts.points.clear();
        }
        for (FigureSeries* series : {&jumps, &contacts, &passages})
            if (!series->points.empty())
                panel.series.push_back(std::move(*series));
    }

    const MotionRecorder* recorder_;
    std::vector<Extent> ranges_; ///< range of each value
};

} // namespace

Figure trajectory_figure(const MotionRecorder& recorder) {
    return TrajectoryPanels(recorder).figure();
}

} // namespace graze
