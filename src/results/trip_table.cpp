#include "graze/results/trip_table.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace graze {

namespace {

/// A cell of the table: empty where the end has not come.
double if_ended(const TripTime& trip, double value) {
    return trip.ended ? value : not_a_number;
}

Table table_of_touch(const OvershootTrips& trips) {
    const LossPoint& point = trips.point;
    const std::string& time = point.model().time_unit;
    Table table{{"overshoot", point.unit}, {"first_speed", ""}, {"cycles", ""}, {"time", time},
                {"end_cycles", ""},        {"end_time", time},  {"ending", ""}, {"simulated_time", time}};
    for (const OvershootTrip& row : trips.of_touch) {
        table.add(row.overshoot, row.predicted->first_speed, if_ended(*row.predicted, row.predicted->cycles),
                  if_ended(*row.predicted, row.predicted->time), if_ended(*row.continued, row.continued->cycles),
                  if_ended(*row.continued, row.continued->time), row.continued->ending,
                  row.simulated ? if_ended(*row.simulated, row.simulated->time) : not_a_number);
    }
    return table;
}

Table table_of_fold(const OvershootTrips& trips) {
    const LossPoint& point = trips.point;
    const bool until_end = trips.end.given;
    const std::string& time = point.model().time_unit;
    std::vector<Table::Column> columns{{"overshoot", point.unit}, {"cycles", ""},           {"time", time},
                                       {"gate_cycles", ""},       {"simulated_cycles", ""}, {"simulated_time", time}};
    if (until_end) {
        columns.push_back({"end_time", time});
        columns.push_back({"ending", ""});
    }
    Table table(std::move(columns));
    for (const FoldTrip& row : trips.of_fold) {
        table.add(row.overshoot, row.cycles, row.cycles * point.cycle, row.gate_cycles,
                  row.passage && row.passage->passed ? row.passage->cycles : not_a_number,
                  row.passage && row.passage->passed ? row.passage->time : not_a_number);
        if (!until_end)
            continue;
        table.add(row.passage ? if_ended(row.passage->trip, row.passage->trip.time) : not_a_number,
                  row.passage ? row.passage->trip.ending : "");
    }
    return table;
}

} // namespace

Table trip_table(const OvershootTrips& trips) {
    return trips.point.fold ? table_of_fold(trips) : table_of_touch(trips);
}

Table trip_table(const OvershootTrips& one, const OvershootTrips& other) {
    const std::string &time = one.point.model().time_unit, &other_time = other.point.model().time_unit;
    Table table{{"overshoot", one.point.unit},
                {"cycles", ""},
                {"time", time},
                {"end_time", time},
                {"beside_cycles", ""},
                {"beside_time", other_time},
                {"beside_end_time", other_time}};
    const std::vector<TripSummary> rows = one.summaries(), others = other.summaries();
    for (std::size_t i = 0; i < std::min(rows.size(), others.size()); ++i) {
        table.add(rows[i].overshoot);
        for (const TripSummary& summary : {rows[i], others[i]}) {
            table.add(summary.cycles, summary.time, summary.end_time);
        }
    }
    return table;
}

Table ramp_table(const LossPoint& point, const std::vector<RampRow>& rows) {
    const std::string& time = point.model().time_unit;
    std::vector<Table::Column> columns{
        {"rate", unit_of_rate(point)}, {"from", point.unit}, {"value", point.unit}, {"delay", point.unit},
        {"delay_cycles", ""},          {"time", time},       {"ending", ""}};
    if (point.fold)
        columns.push_back({"predicted_delay", point.unit});
    Table table(std::move(columns));
    for (const RampRow& row : rows) {
        const TripTime& trip = row.ramped.trip;
        const double delay = row.delay.value_or(not_a_number);
        table.add(row.rate, row.from, if_ended(trip, row.ramped.value), delay, delay / (row.rate * point.cycle),
                  if_ended(trip, trip.time), trip.ending);
        if (row.predicted_delay)
            table.add(*row.predicted_delay);
    }
    return table;
}

Table wave_table(const LossPoint& point, const std::vector<double>& amplitudes, const std::vector<TripTime>& trips) {
    Table table(
        {{"amplitude", point.unit}, {"trips", ""}, {"cycles", ""}, {"time", point.model().time_unit}, {"ending", ""}});
    for (std::size_t i = 0; i < std::min(amplitudes.size(), trips.size()); ++i)
        table.add(amplitudes[i], trips[i].ended ? "yes" : "no", if_ended(trips[i], trips[i].cycles),
                  if_ended(trips[i], trips[i].time), trips[i].ending);
    return table;
}

Table noise_table(const LossPoint& point, const std::vector<double>& levels, const std::vector<NoisyTrips>& all) {
    Table table{{"level", point.unit}, {"motions", ""}, {"trips", ""},       {"probability", ""}, {"low", ""},
                {"high", ""},          {"beyond", ""},  {"half_cycles", ""}, {"failed", ""}};
    for (std::size_t i = 0; i < std::min(levels.size(), all.size()); ++i) {
        const NoisyTrips& trips = all[i];
        table.add(levels[i], trips.motions, trips.trips, trips.probability.value, trips.probability.low,
                  trips.probability.high, static_cast<double>(trips.beyond) / static_cast<double>(trips.motions),
                  trips.half, trips.failed);
    }
    return table;
}

} // namespace graze
