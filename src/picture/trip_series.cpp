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

FigurePanel trip_panel(const std::string& x, const std::string& x_unit, const std::string& y,
                       const std::string& y_unit) {
    return {.x_label = x,
            .y_label = y,
            .x_unit = x_unit,
            .y_unit = y_unit,
            .logarithmic_x = true,
            .roomy_y = true,
            .roomy_x = true};
}

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
    FigurePanel panel =
        trip_panel(all.size() > 1 ? "distance of " + point.name
                                  : point.name + (point.side > 0 ? " beyond its " : " short of its ") + point.kind(),
                   point.unit, "time", point.model().time_unit);
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

Figure ramp_figure(const LossPoint& point, const std::vector<RampRow>& rows, const std::string& end) {
    FigurePanel panel = trip_panel("rate of " + point.name, unit_of_rate(point), "delay of " + point.name, point.unit);
    panel.logarithmic_y = true;
    FigureSeries simulated{"simulation, until " + end, FigureSeries::Style::circles, 1},
        predicted{"normal form", FigureSeries::Style::dashed};
    for (const RampRow& row : rows) {
        if (row.delay && *row.delay / row.rate > 0)
            simulated.points.push_back({std::abs(row.rate), std::abs(*row.delay)});
        if (row.predicted_delay)
            predicted.points.push_back({std::abs(row.rate), std::abs(*row.predicted_delay)});
    }
    panel.series.push_back(simulated);
    if (point.fold)
        panel.series.push_back(predicted);
    return {.panels = {std::move(panel)}};
}

Figure wave_figure(const LossPoint& point, const TripOrigin& origin, const std::vector<double>& amplitudes,
                   const std::vector<TripTime>& trips, const std::string& end) {
    FigurePanel panel = trip_panel("amplitude of " + point.name, point.unit, "time", point.model().time_unit);
    FigureSeries times{"until " + end, FigureSeries::Style::circles, 1};
    for (std::size_t i = 0; i < trips.size(); ++i)
        if (trips[i].ended && amplitudes[i] != 0)
            times.points.push_back({std::abs(amplitudes[i]), trips[i].time});
    panel.marks.push_back(std::abs(origin.point - origin.value));
    panel.series.push_back(times);
    return {.panels = {std::move(panel)}};
}

Figure noise_figure(const LossPoint& point, const std::vector<double>& levels, const std::vector<NoisyTrips>& all,
                    const NoiseSettings& settings) {
    using Style = FigureSeries::Style;
    FigurePanel panel = trip_panel("level of noise in " + point.name, point.unit, "probability of a trip", "");
    FigureSeries shares{fmt::format("within {} cycles", settings.cycles), Style::circles, 1},
        low{fmt::format("limits of confidence, {:g} %", 100 * settings.confidence), Style::line}, high{"", Style::line},
        beyond{"beyond the " + std::string(point.kind()) + " at any time", Style::dotted, 2};
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (levels[i] == 0) // has no place on the axis
            continue;
        shares.points.push_back({levels[i], all[i].probability.value});
        low.points.push_back({levels[i], all[i].probability.low});
        high.points.push_back({levels[i], all[i].probability.high});
        beyond.points.push_back({levels[i], static_cast<double>(all[i].beyond) / static_cast<double>(all[i].motions)});
    }
    panel.series = {shares, low, high, beyond};
    return {.panels = {std::move(panel)}};
}

} // namespace graze
