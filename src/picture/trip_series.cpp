#include "graze/picture/trip_series.hpp"

#include "graze/base/require.hpp"

#include "base/special_numbers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace graze {

void add_trips(FigurePanel& panel, const std::vector<std::pair<double, TripTime>>& trips, const std::string& title,
               std::size_t colour, int symbol, bool at_fold) {
    FigureSeries line{"", FigureSeries::Style::line, colour, {}};
    FigureSeries marks{title, FigureSeries::Style::symbols, colour, {}};
    marks.symbol = symbol;
    const TripTime* before = nullptr;
    for (const auto& [overshoot, trip] : trips) {
        if (!at_fold && before && before->contacts != trip.contacts)
            line.points.push_back({not_a_number, not_a_number});
        line.points.push_back({overshoot, trip.time});
        marks.points.push_back({overshoot, trip.time});
        before = &trip;
    }
    if (marks.points.empty())
        return;
    panel.series.push_back(std::move(line));
    panel.series.push_back(std::move(marks));
}

namespace {

FigureSeries series_of(const std::string& title, FigureSeries::Style style, std::size_t colour) {
    return {title, style, colour, {}};
}

void add_touch(FigurePanel& panel, const OvershootTrips& trips, const std::string& which) {
    const std::string level = fmt::format("speed {:.4g}", level_until(trips.point, trips.end.end));
    const std::string& end = trips.end.words;
    std::vector<std::pair<double, TripTime>> map, continued;
    FigureSeries simulated = series_of(which + "simulation alone, until " + end, FigureSeries::Style::circles, 2);
    for (const OvershootTrip& row : trips.of_touch) {
        const double x = std::abs(row.overshoot);
        if (x == 0) // has no place on the axis
            continue;
        if (row.predicted->ended)
            map.emplace_back(x, *row.predicted);
        if (row.continued->ended)
            continued.emplace_back(x, *row.continued);
        if (row.simulated && row.simulated->ended)
            simulated.points.push_back({x, row.simulated->time});
    }
    constexpr int disc = 7, triangle = 9; // gnuplot's symbols
    add_trips(panel, map, which + "map, until " + level, 0, triangle);
    add_trips(panel, continued, which + "map, then simulation, until " + end, 1, disc);
    panel.series.push_back(std::move(simulated));
}

void add_fold(FigurePanel& panel, const OvershootTrips& trips, const std::string& which) {
    FigureSeries form = series_of(which + "normal form, from far away", FigureSeries::Style::dashed, 3);
    FigureSeries gated = series_of(which + "normal form, from gate to gate", FigureSeries::Style::line, 3);
    FigureSeries simulated = series_of(which + "simulation, until " + trips.end.words, FigureSeries::Style::circles, 4);
    for (const TripSummary& summary : trips.summaries()) {
        form.points.push_back({std::abs(summary.overshoot), summary.time});
        if (std::isfinite(summary.end_time))
            simulated.points.push_back({std::abs(summary.overshoot), summary.end_time});
    }
    for (const FoldTrip& row : trips.of_fold)
        gated.points.push_back({std::abs(row.overshoot), row.gate_cycles * trips.point.cycle});
    panel.series.insert(panel.series.end(), {form, gated, simulated});
}

} // namespace

Figure trip_figure(const std::vector<OvershootTrips>& all) {
    require_index(0, all.size(), "point with trips");
    const LossPoint& point = all.front().point;
    FigurePanel panel;
    panel.x_label = point.name + (point.side > 0 ? " beyond its " : " short of its ") + point.kind();
    if (all.size() > 1)
        panel.x_label = "distance of " + point.name;
    panel.x_unit = point.unit;
    panel.y_label = "time";
    panel.y_unit = point.model().time_unit;
    panel.logarithmic_x = true;
    panel.roomy_x = panel.roomy_y = true;
    for (const OvershootTrips& trips : all) {
        const std::string which = all.size() > 1 ? std::string(trips.point.kind()) + ": " : "";
        panel.logarithmic_y = panel.logarithmic_y || trips.point.fold;
        if (trips.point.fold)
            add_fold(panel, trips, which);
        else
            add_touch(panel, trips, which);
    }
    Figure figure;
    figure.panels.push_back(std::move(panel));
    return figure;
}

} // namespace graze
