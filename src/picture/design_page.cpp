#include "graze/picture/design_page.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/picture/trip_series.hpp"
#include "graze/picture/yield_picture.hpp"
#include "picture/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace graze {

namespace {

struct ClassStyle {
    GrazingOutcome outcome;
    std::size_t colour;
};
constexpr std::array<ClassStyle, 4> classes{{{GrazingOutcome::lost, 1},
                                             {GrazingOutcome::persists, 0},
                                             {GrazingOutcome::folds, 3},
                                             {GrazingOutcome::undecided, FigureSeries::grey}}};

class Page {
public:
    Page(const Design& design, const TripPoint& trip, const DesignReport& report)
        : design_(design), trip_(trip), report_(report) {
        const Model& model = trip.system.model();
        unit_ = model.parameter_unit(design.control);
        time_unit_ = model.time_unit;
    }

    Figure draw() {
        figure_.title = title();
        figure_.symbols.push_back(design_.control);
        for (const DesignDimension& one : design_.dimensions)
            figure_.symbols.push_back(one.name);
        for (const DimensionCurve& curve : report_.curves)
            add_curve(curve);
        for (const DimensionPlane& plane : report_.planes)
            add_plane(plane);
        add_times();
        if (report_.tuning)
            add_tuning(*report_.tuning);
        if (report_.yield)
            add_yield();
        arrange();
        return std::move(figure_);
    }

private:
    /// Chooses the number of columns so that the page is about as high as a sheet of paper. Panels keep a legible size:
    /// a page with more columns is wider.
    void arrange() {
        constexpr std::size_t most_rows = 4;
        constexpr double column = 85, font = 9; // mm and points, as for a page of two columns
        const std::size_t panels = figure_.panels.size();
        figure_.columns = std::max<std::size_t>(2, (panels + most_rows - 1) / most_rows);
        figure_.style.width = column * static_cast<double>(figure_.columns);
        figure_.style.font_size = font;
    }

    std::string title() const {
        std::string text = fmt::format("{}: {} at {} = {:.6g}{}{}", design_.name, class_name(report_.found.outcome),
                                       design_.control, report_.value, unit_.empty() ? "" : " ", unit_);
        for (const OvershootTrip& row : report_.times.rows)
            if (const TripTime* best = row.best()) {
                text += fmt::format(", in {:.4g}{}{} at {:.2g} beyond", best->time, time_unit_.empty() ? "" : " ",
                                    time_unit_, std::abs(row.overshoot));
                break;
            }
        if (report_.reset.value)
            text += fmt::format(", back at {:.6g}", *report_.reset.value);
        return text;
    }

    FigurePanel value_panel(const DesignDimension& dimension) const {
        return {.x_label = dimension.name,
                .y_label = design_.control,
                .x_unit = dimension.unit,
                .y_unit = unit_,
                .x_words = dimension.text,
                .roomy_y = true};
    }

    double nominal(const DesignDimension& dimension) const {
        return trip_.point.solution.orbit.parameters[dimension.parameter.place()];
    }

    /// A symbol at the values of the device.
    static FigureSeries mark(PlanePoint at) {
        return {"the device", FigureSeries::Style::symbols, FigureSeries::black, {at}};
    }

    /// One line for each class; it extends to the first point of the next class.
    void add_curve(const DimensionCurve& curve) {
        const DesignDimension& dimension = design_.dimensions[curve.dimension];
        FigurePanel panel = value_panel(dimension);
        for (const ClassStyle& style : classes) {
            FigureSeries series{std::string(class_name(style.outcome)), FigureSeries::Style::line, style.colour};
            bool any = false, before = false;
            for (const MappedValue& one : curve.points) {
                const bool usable = one.found && one.admissible, is = usable && one.outcome == style.outcome;
                series.points.push_back({one.x, usable && (is || before) ? one.value : not_a_number});
                any = any || is;
                before = is;
            }
            if (any)
                panel.series.push_back(std::move(series));
        }
        panel.series.push_back(mark({nominal(dimension), report_.value}));
        figure_.panels.push_back(std::move(panel));
    }

    void add_plane(const DimensionPlane& plane) {
        const DesignDimension &x = design_.dimensions[plane.across], &y = design_.dimensions[plane.up];
        FigurePanel panel{.title = fmt::format("{} at which it trips", design_.control),
                          .x_label = x.name,
                          .y_label = y.name,
                          .x_unit = x.unit,
                          .y_unit = y.unit,
                          .x_range = std::pair(x.least, x.greatest),
                          .y_range = std::pair(y.least, y.greatest)};
        add_classes(panel, plane, x, y);
        add_contours(panel, plane);
        panel.series.push_back(mark({nominal(x), nominal(y)}));
        figure_.panels.push_back(std::move(panel));
    }

    /// Cells coloured by class, below the contours.
    static void add_classes(FigurePanel& panel, const DimensionPlane& plane, const DesignDimension& x,
                            const DesignDimension& y) {
        const auto points = static_cast<double>(std::lround(std::sqrt(static_cast<double>(plane.points.size()))));
        const double half_x = 0.5 * (x.greatest - x.least) / (points - 1);
        const double half_y = 0.5 * (y.greatest - y.least) / (points - 1);
        for (const ClassStyle& style : classes) {
            FigureSeries series{std::string(class_name(style.outcome)), FigureSeries::Style::cells, style.colour};
            for (const MappedValue& one : plane.points)
                if (one.found && one.admissible && one.outcome == style.outcome)
                    series.cells.push_back({std::max(x.least, one.x - half_x), std::min(x.greatest, one.x + half_x),
                                            std::max(y.least, one.y - half_y), std::min(y.greatest, one.y + half_y)});
            if (!series.cells.empty())
                panel.series.push_back(std::move(series));
        }
    }

    static void add_contours(FigurePanel& panel, const DimensionPlane& plane) {
        const auto points = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(plane.points.size()))));
        ContourGrid grid;
        for (std::size_t i = 0; i < points; ++i) {
            grid.x.push_back(plane.points[i].x);
            grid.y.push_back(plane.points[i * points].y);
        }
        for (const MappedValue& one : plane.points)
            grid.values.push_back(one.found && one.admissible ? one.value : not_a_number);
        constexpr std::size_t about = 8; // approximate number of levels
        for (const double level : contour_levels(grid, about)) {
            FigureSeries series{"", FigureSeries::Style::line, FigureSeries::black, contour_line(grid, level)};
            if (series.points.empty())
                continue;
            panel.labels.push_back({series.points[series.points.size() / 2 / 3 * 3], fmt::format("{:.6g}", level),
                                    FigureSeries::black, 1});
            panel.series.push_back(std::move(series));
        }
    }

    void add_times() {
        FigurePanel panel{.x_label = design_.control + " beyond the trip value",
                          .y_label = "time",
                          .x_unit = unit_,
                          .y_unit = time_unit_,
                          .logarithmic_x = true,
                          .roomy_y = true,
                          .roomy_x = true};
        std::vector<std::pair<double, TripTime>> best;
        FigureSeries simulated{"simulation alone", FigureSeries::Style::circles, 2};
        for (const OvershootTrip& row : report_.times.rows) {
            if (row.continued && row.continued->ended)
                best.emplace_back(std::abs(row.overshoot), *row.continued);
            if (row.simulated && row.simulated->ended)
                simulated.points.push_back({std::abs(row.overshoot), row.simulated->time});
        }
        constexpr int disc = 7; // gnuplot's symbol
        const bool at_fold = !trip_.is_touch();
        add_trips(panel, best, at_fold ? "normal form, then simulation" : "map, then simulation", 1, disc, at_fold);
        if (!simulated.points.empty())
            panel.series.push_back(std::move(simulated));
        if (!panel.series.empty())
            figure_.panels.push_back(std::move(panel));
    }

    void add_tuning(const Tuning& tuning) {
        const DesignDimension& stop = design_.dimensions[*design_.adjustable];
        FigureSeries line{.style = FigureSeries::Style::line};
        for (const TuningPoint& one : tuning.points)
            line.points.push_back({one.value, one.found && one.value >= tuning.least && one.value <= tuning.greatest
                                                  ? one.position
                                                  : not_a_number});
        figure_.panels.push_back({.title = "Tuning",
                                  .x_label = design_.control,
                                  .y_label = stop.name,
                                  .x_unit = unit_,
                                  .y_unit = stop.unit,
                                  .roomy_y = true,
                                  .roomy_x = true,
                                  .series = {line, mark({report_.value, nominal(stop)})},
                                  .marks = {tuning.least, tuning.greatest}});
    }

    void add_yield() {
        try {
            Figure picture = yield_picture(*report_.yield, design_.control, unit_, report_.yield_settings.least,
                                           report_.yield_settings.greatest);
            if (report_.yield->within)
                picture.panels.front().title =
                    fmt::format("{:.1f} percent within the limits", 100 * report_.yield->within->value);
            figure_.panels.push_back(std::move(picture.panels.front()));
        } catch (const InputError&) { // all devices are equal: the distribution has no width
        }
    }

    const Design& design_;
    const TripPoint& trip_;
    const DesignReport& report_;
    std::string unit_, time_unit_;
    Figure figure_;
};

} // namespace

Figure design_page(const Design& design, const TripPoint& trip, const DesignReport& report) {
    return Page(design, trip, report).draw();
}

} // namespace graze
