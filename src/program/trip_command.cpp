#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/trip_series.hpp"
#include "graze/trip/overshoot_trip.hpp"
#include "program/asked_trip.hpp"
#include "program/commands.hpp"
#include "program/drawing.hpp"
#include "program/interrupt.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// The overshoots that are asked for, or the usual ones on the side on which the motion is lost.
std::vector<double> overshoots_of(const LossPoint& point, const std::vector<std::string>& asked) {
    std::vector<double> values = numbers_by_decades(point.model(), asked, "--overshoot");
    if (!values.empty())
        return values;
    return usual_overshoots(point.value, point.side);
}

TripOptions trip_options(const LossPoint& point, const TripArguments& arguments) {
    TripOptions options;
    constexpr long usual = 2000;
    options.cycles = static_cast<double>(arguments.cycles.value_or(usual));
    options.disturbance = disturbance_of(point.model(), arguments.disturbances);
    options.interrupted = [] { return InterruptGuard::requested(); };
    return options;
}

/// Messages about trips that have not come to their end.
std::vector<std::string> lacks_of(const OvershootTrips& trips) {
    std::vector<std::string> lacks;
    for (std::size_t i = 0; i < trips.size(); ++i)
        if (const TripTime* const unfinished = trips.unfinished(i))
            lacks.push_back(fmt::format("the trip at the overshoot {:g} has not come to its end: {}",
                                        trips.point.fold ? trips.of_fold[i].overshoot : trips.of_touch[i].overshoot,
                                        why_not(*unfinished, "give more --cycles, or another end by --until")));
    return lacks;
}

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

Table table_of_both(const OvershootTrips& one, const OvershootTrips& other) {
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

void require_drawable(const std::vector<double>& overshoots) {
    if (std::all_of(overshoots.begin(), overshoots.end(), [](double one) { return one == 0; }))
        throw InputError(Place{"--plot", 0, 0}, "an overshoot of zero has no place on a logarithmic axis",
                         "give others to be drawn beside it, or leave --plot out for the table");
}

} // namespace

int trip_command(const TripArguments& arguments, const Console& console) {
    if (!arguments.plot.empty())
        picture_ending(arguments.plot, "--plot", {"svg", "png", "pdf", "eps"});
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    if (is_disturbed(arguments))
        return disturbed_trips(file, arguments, console);
    if (!arguments.at.empty())
        throw InputError(Place{"--at", 0, 0}, "nothing changes in time", "give --ramp, --wave or --noise too");
    std::vector<AskedTrip> asked{asked_trip(file, arguments.point, arguments, "POINT")};
    if (!arguments.beside.empty())
        asked.push_back(asked_trip(file, arguments.beside, arguments, "--beside"));
    const LossPoint& first = asked.front().point;
    const std::vector<double> overshoots = overshoots_of(first, arguments.overshoots);
    if (!arguments.plot.empty())
        require_drawable(overshoots);
    const InterruptGuard guard;
    std::vector<OvershootTrips> all;
    std::vector<std::string> lacks;
    for (const AskedTrip& one : asked) {
        std::vector<double> own = overshoots;
        for (double& overshoot : own)
            overshoot = &one == &asked.front() ? overshoot : one.point.side * std::abs(overshoot);
        if (!all.empty() && all.front().interrupted)
            own.clear();
        all.push_back(overshoot_trips(one.point, one.end, own, trip_options(one.point, arguments)));
        const std::vector<std::string> here = lacks_of(all.back());
        lacks.insert(lacks.end(), here.begin(), here.end());
    }
    const bool interrupted = all.front().interrupted || all.back().interrupted;
    if (arguments.plot.empty() || interrupted) {
        const OvershootTrips& one = all.front();
        const Table table = all.size() > 1 ? table_of_both(one, all.back())
                            : first.fold   ? table_of_fold(one)
                                           : table_of_touch(one);
        deliver(table, arguments.output, heading_of(file, asked.front()), console);
    } else {
        draw_figure(trip_figure(all), arguments.plot, arguments.data);
        console.out << arguments.plot << '\n';
    }
    if (interrupted) {
        console.err << fmt::format("graze: interrupted; {} of {} overshoots are done\n", all.back().size(),
                                   overshoots.size());
        return InterruptGuard::exit_code();
    }
    tell_lacks(lacks, console);
    return lacks.empty() ? exit_success : exit_irregular;
}

} // namespace graze
