#include "graze/picture/trip_series.hpp"

#include "graze/base/require.hpp"

#include "base/special_numbers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace graze {

void add_trips(FigurePanel& panel, const std::vector<std::pair<double, TripTime>>& trips, const std::string& title,
               std::size_t colour, int symbol, bool at_fold) {
    FigureSeries line{"", FigureSeries::Style::line, colour};
    FigureSeries marks{.title = title, .style = FigureSeries::Style::symbols, .colour = colour, .symbol = symbol};
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

void add_touch(FigurePanel& panel, const OvershootTrips& trips, const std::string& which) {
    const std::string level = fmt::format("speed {:.4g}", level_until(trips.point, trips.end.end));
    const std::string& end = trips.end.words;
    std::vector<std::pair<double, TripTime>> map, continued;
    FigureSeries simulated{which + "simulation alone, until " + end, FigureSeries::Style::circles, 2};
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
    FigureSeries form{which + "normal form, from far away", FigureSeries::Style::dashed, 3};
    FigureSeries gated{which + "normal form, from gate to gate", FigureSeries::Style::line, 3};
    FigureSeries simulated{which + "simulation, until " + trips.end.words, FigureSeries::Style::circles, 4};
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
    const std::string beyond = point.name + (point.side > 0 ? " beyond its " : " short of its ") + point.kind();
    FigurePanel panel{.x_label = all.size() > 1 ? "distance of " + point.name : beyond,
                      .y_label = "time",
                      .x_unit = point.unit,
                      .y_unit = point.model().time_unit,
                      .logarithmic_x = true,
                      .roomy_y = true,
                      .roomy_x = true};
    for (const OvershootTrips& trips : all) {
        const std::string which = all.size() > 1 ? std::string(trips.point.kind()) + ": " : "";
        panel.logarithmic_y = panel.logarithmic_y || trips.point.fold;
        if (trips.point.fold)
            add_fold(panel, trips, which);
        else
            add_touch(panel, trips, which);
    }
    return {.panels = {std::move(panel)}};
}

} // namespace graze
