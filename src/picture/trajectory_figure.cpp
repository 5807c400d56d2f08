#include "graze/picture/trajectory_figure.hpp"

#include "picture/curve.hpp"
#include "picture/shown_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace graze {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double unseen = 2e-4;           ///< of a panel's size
constexpr double last_moments = 0.005;    ///< of a motion that ends in a singularity: they do not count for the axes
constexpr std::size_t most_marked = 2000; ///< contacts: of more, marks hide the curve
constexpr std::size_t section_colour = 1;

struct ValueRange {
    double least = std::numeric_limits<double>::infinity(), greatest = -std::numeric_limits<double>::infinity();
    void add(double value) {
        if (!std::isfinite(value))
            return;
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
    double span() const { return std::max(greatest - least, 0.0); }
};

class TrajectoryPanels {
public:
    explicit TrajectoryPanels(const MotionRecorder& recorder) : recorder_(&recorder) {
        for (std::size_t c = 0; c < recorder.contents().columns.size(); ++c)
            ranges_.push_back(range_of(c));
    }

    Figure figure() const {
        Figure figure;
        const std::vector<std::size_t> histories = shown_histories();
        const auto& portraits = recorder_->contents().portraits;
        figure.columns = !histories.empty() && !portraits.empty() ? 2 : portraits.size() > 1 ? 2 : 1;
        for (std::size_t i = 0; i < std::max(histories.size(), portraits.size()); ++i) {
            if (i < histories.size())
                figure.panels.push_back(panel(std::nullopt, histories[i]));
            if (i < portraits.size()) {
                figure.panels.push_back(panel(portraits[i].first, portraits[i].second));
                figure.panels.back().rows = rows_of(i, portraits.size(), histories.size());
            }
        }
        for (const auto& parameter : recorder_->model().parameters)
            figure.symbols.push_back(parameter.name);
        for (const auto& state : recorder_->model().states)
            figure.symbols.push_back(state.name);
        return figure;
    }

private:
    using Column = std::optional<std::size_t>; ///< none: the time

    /// Portraits share the height of the histories beside them.
    static std::size_t rows_of(std::size_t portrait, std::size_t portraits, std::size_t histories) {
        if (histories <= portraits)
            return 1;
        return (portrait + 1) * histories / portraits - portrait * histories / portraits;
    }

    std::vector<std::size_t> shown_histories() const {
        constexpr double resolved = 1e-9; // as an axis shows a constant
        const MotionPanelChoice& contents = recorder_->contents();
        std::vector<std::size_t> shown;
        for (const std::size_t column : contents.histories) {
            const ValueRange& range = ranges_[column];
            if (contents.chosen || range.span() > resolved * std::max(std::abs(range.least), std::abs(range.greatest)))
                shown.push_back(column);
        }
        return shown.empty() ? contents.histories : shown;
    }

    double start() const { return recorder_->arcs().front().times.front(); }
    double end() const { return recorder_->arcs().back().times.back(); }

    ValueRange range_of(std::size_t column) const {
        ValueRange range;
        if (recorder_->arcs().empty())
            return range;
        const std::size_t columns = recorder_->contents().columns.size();
        const double last = recorder_->singularity() ? end() - last_moments * (end() - start()) : end();
        for (const MotionRecorder::Arc& arc : recorder_->arcs())
            for (std::size_t i = 0; i < arc.times.size() && arc.times[i] <= last; ++i)
                range.add(arc.values[i * columns + column]);
        return range;
    }

    FigurePanel panel(Column x, std::size_t y) const {
        FigurePanel panel;
        describe(panel.x_label, panel.x_words, panel.x_unit, x);
        describe(panel.y_label, panel.y_words, panel.y_unit, y);
        panel.roomy_y = true;
        panel.roomy_x = x.has_value();
        if (recorder_->arcs().empty())
            return panel;
        limit(panel, x, y);
        add_curve(panel, x, y);
        add_marks(panel, x, y);
        return panel;
    }

    void describe(std::string& label, std::string& words, std::string& unit, Column column) const {
        if (!column) {
            label = "t";
            words = "time";
            unit = recorder_->model().time_unit;
            return;
        }
        const NamedValue& value = recorder_->contents().columns[*column];
        label = value.name;
        words = first_words(value.text);
        unit = value.unit;
    }

    void limit(FigurePanel& panel, Column x, std::size_t y) const {
        constexpr double margin = 0.08, after = 0.01;
        const auto roomy = [&](std::size_t column) {
            const ValueRange& range = ranges_[column];
            const double room = margin * (range.span() > 0 ? range.span() : std::max(std::abs(range.least), 1.0));
            return std::pair(range.least - room, range.greatest + room);
        };
        if (const auto singularity = recorder_->singularity()) {
            panel.y_range = roomy(y);
            if (x)
                panel.x_range = roomy(*x);
            else
                panel.x_range = {start(), *singularity + after * (*singularity - start())};
            if (!x) {
                panel.marks.push_back(*singularity);
                panel.marks_title = "singularity";
            }
        } else if (!x && end() > start()) {
            panel.x_range = {start(), end()};
        }
    }

    double value(Column column, double time, const double* values) const { return column ? values[*column] : time; }
    double period(Column column) const { return column ? recorder_->period(*column) : 0; }

    /// Of each arc; a phase that begins anew, or a quantity without a value, interrupts it.
    void add_curve(FigurePanel& panel, Column x, std::size_t y) const {
        FigureSeries curve{"", FigureSeries::Style::line, 0, {}};
        const std::size_t columns = recorder_->contents().columns.size();
        const double width = x ? ranges_[*x].span() : end() - start(), height = ranges_[y].span();
        const auto wraps = [](double from, double to, double period) {
            return period > 0 && std::abs(to - from) > period / 2;
        };
        Polyline line;
        const auto flush = [&] {
            if (line.empty())
                return;
            const Polyline seen = width > 0 && height > 0 ? simplified(line, width, height, unseen) : line;
            curve.points.insert(curve.points.end(), seen.begin(), seen.end());
            curve.points.push_back({nothing, nothing});
            line.clear();
        };
        for (const MotionRecorder::Arc& arc : recorder_->arcs()) {
            for (std::size_t i = 0; i < arc.times.size(); ++i) {
                const double* values = &arc.values[i * columns];
                const PlanePoint point{value(x, arc.times[i], values), values[y]};
                const bool finite = std::isfinite(point.x) && std::isfinite(point.y);
                if (!finite || (!line.empty() &&
                                (wraps(line.back().x, point.x, period(x)) || wraps(line.back().y, point.y, period(y)))))
                    flush();
                if (finite)
                    line.push_back(point);
            }
            flush();
        }
        panel.series.push_back(std::move(curve));
    }

    void add_marks(FigurePanel& panel, Column x, std::size_t y) const {
        FigureSeries jumps{"jump", FigureSeries::Style::dotted, FigureSeries::black, {}};
        FigureSeries contacts{"contact", FigureSeries::Style::symbols, FigureSeries::black, {}};
        FigureSeries passages{recorder_->section_names(), FigureSeries::Style::circles, section_colour, {}};
        const bool cyclic = period(x) > 0 || period(y) > 0;
        for (const MotionRecorder::Jump& jump : recorder_->jumps()) {
            const PlanePoint before{value(x, jump.time, jump.before.data()), jump.before[y]};
            const PlanePoint after{value(x, jump.time, jump.after.data()), jump.after[y]};
            const bool moves = before.x != after.x || before.y != after.y;
            if (moves && !cyclic)
                jumps.points.insert(jumps.points.end(), {before, after, {nothing, nothing}});
            if (jump.marked)
                contacts.points.push_back(before);
            if (jump.marked && moves)
                contacts.points.push_back(after);
        }
        for (const MotionRecorder::Point& passage : recorder_->passages())
            passages.points.push_back({value(x, passage.time, passage.values.data()), passage.values[y]});
        if (contacts.points.size() > most_marked) {
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
    std::vector<ValueRange> ranges_; ///< of each column
};

} // namespace

Figure trajectory_figure(const MotionRecorder& recorder) {
    return TrajectoryPanels(recorder).figure();
}

} // namespace graze
