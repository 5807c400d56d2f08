#include "graze/base/input_error.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/trip_series.hpp"
#include "program/commands.hpp"
#include "program/disturbed_trips.hpp"
#include "program/drawing.hpp"
#include "program/empty_cell.hpp"
#include "program/interrupt.hpp"
#include "program/loss_point.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// What is known of one overshoot.
struct TripRow {
    double overshoot = 0;
    // Of a touch.
    PredictedTrip predicted;           ///< until the map's level
    TripTime continued;                ///< until the end that was asked for
    std::optional<TripTime> simulated; ///< likewise
    // Of a fold.
    double cycles = nothing, gate_cycles = nothing;
    std::optional<SimulatedPassage> passage;
};

/// All rows of one point.
struct Trips {
    LossPoint point;
    AskedEnd end;
    std::vector<TripRow> rows{};
    std::vector<std::string> lacks{}; ///< what has not come to its end
};

/// Those asked for, or ten from 1e-2 to 1e-20 of the size of the parameter, on the side on which the motion is lost.
std::vector<double> overshoots_of(const LossPoint& point, const std::vector<std::string>& asked) {
    std::vector<double> values = numbers_by_decades(point.model(), asked, "--overshoot");
    if (!values.empty())
        return values;
    return usual_overshoots(point.value, point.side);
}

TripOptions options_of(const LossPoint& point, const TripArguments& arguments) {
    TripOptions options;
    constexpr long usual = 2000;
    options.cycles = static_cast<double>(arguments.cycles.value_or(usual));
    options.disturbance = disturbance_of(point.model(), arguments.disturbances);
    options.interrupted = [] { return InterruptGuard::requested(); };
    if (point.fold && !options.disturbance.empty())
        throw InputError(Place{"--disturbance", 0, 0}, "a passage through a fold begins before it",
                         "leave it out, or choose a touch (GR)");
    return options;
}

/// One more row. @return false when it was interrupted
bool add_row(Trips& trips, double overshoot, const TripOptions& options) {
    const LossPoint& point = trips.point;
    TripRow row;
    row.overshoot = overshoot;
    std::string lack;
    constexpr const char* longer = "give more --cycles, or another end by --until";
    if (point.fold) {
        row.cycles = cycles_of_passage(*point.fold, overshoot);
        row.gate_cycles = cycles_of_passage(*point.fold, overshoot, -point.fold->gate, point.fold->gate);
        if (row.cycles < options.cycles && std::abs(overshoot) >= least_overshoot(*point.fold)) {
            row.passage =
                simulated_passage(point.system, *point.fold, overshoot, trips.end.end, !trips.end.given, options);
            if (!(trips.end.given ? row.passage->trip.ended : row.passage->passed))
                lack = why_not(row.passage->trip, longer);
        }
    } else {
        PredictionOptions prediction;
        const double speed = trips.end.end.speed;
        prediction.level = speed > 0 ? std::min(point.level, speed) : point.level;
        prediction.disturbance = options.disturbance;
        row.predicted = predicted_trip(point.map, point.verdict, overshoot, prediction);
        row.continued =
            continued_trip(point.system, point.map, point.parameter, overshoot, row.predicted, trips.end.end, options);
        if (overshoot == 0 || std::abs(overshoot) >= least_overshoot(point.map, point.parameter))
            row.simulated = simulated_trip(point.system, point.map, point.parameter, overshoot, trips.end.end, options);
        if (!row.continued.ended)
            lack = why_not(row.continued, longer);
    }
    if (InterruptGuard::requested())
        return false;
    if (!lack.empty())
        trips.lacks.push_back(
            fmt::format("the trip at the overshoot {:g} has not come to its end: {}", overshoot, lack));
    trips.rows.push_back(std::move(row));
    return true;
}

/// A number of the table: missing where the end has not come.
double if_ended(const TripTime& trip, double value) {
    return trip.ended ? value : nothing;
}

Table table_of_touch(const Trips& trips) {
    const std::string& time = trips.point.model().time_unit;
    Table table({{"overshoot", trips.point.unit},
                 {"first_speed", ""},
                 {"cycles", ""},
                 {"time", time},
                 {"end_cycles", ""},
                 {"end_time", time},
                 {"ending", ""},
                 {"simulated_time", time}});
    for (const TripRow& row : trips.rows) {
        table.add(row.overshoot);
        table.add(row.predicted.first_speed);
        table.add(if_ended(row.predicted, row.predicted.cycles));
        table.add(if_ended(row.predicted, row.predicted.time));
        table.add(if_ended(row.continued, row.continued.cycles));
        table.add(if_ended(row.continued, row.continued.time));
        table.add(row.continued.ending);
        table.add(row.simulated ? if_ended(*row.simulated, row.simulated->time) : nothing);
    }
    return table;
}

Table table_of_fold(const Trips& trips) {
    const std::string& time = trips.point.model().time_unit;
    std::vector<Table::Column> columns{
        {"overshoot", trips.point.unit}, {"cycles", ""},          {"time", time}, {"gate_cycles", ""},
        {"simulated_cycles", ""},        {"simulated_time", time}};
    if (trips.end.given) {
        columns.push_back({"end_time", time});
        columns.push_back({"ending", ""});
    }
    Table table(std::move(columns));
    for (const TripRow& row : trips.rows) {
        table.add(row.overshoot);
        table.add(row.cycles);
        table.add(row.cycles * trips.point.cycle);
        table.add(row.gate_cycles);
        table.add(row.passage && row.passage->passed ? row.passage->cycles : nothing);
        table.add(row.passage && row.passage->passed ? row.passage->time : nothing);
        if (!trips.end.given)
            continue;
        table.add(row.passage ? if_ended(row.passage->trip, row.passage->trip.time) : nothing);
        table.add(row.passage ? row.passage->trip.ending : "");
    }
    return table;
}

/// What a row says first of all, of a touch as of a fold: by the map or the normal form, and by simulation.
struct Summary {
    double cycles = nothing, time = nothing, end_time = nothing;
};
Summary summary_of(const Trips& trips, const TripRow& row) {
    if (!trips.point.fold)
        return {if_ended(row.predicted, row.predicted.cycles), if_ended(row.predicted, row.predicted.time),
                if_ended(row.continued, row.continued.time)};
    Summary result{row.cycles, row.cycles * trips.point.cycle, nothing};
    if (row.passage && trips.end.given)
        result.end_time = if_ended(row.passage->trip, row.passage->trip.time);
    else if (row.passage && row.passage->passed)
        result.end_time = row.passage->time;
    return result;
}

Table table_of_both(const Trips& one, const Trips& other) {
    const std::string &time = one.point.model().time_unit, &other_time = other.point.model().time_unit;
    Table table({{"overshoot", one.point.unit},
                 {"cycles", ""},
                 {"time", time},
                 {"end_time", time},
                 {"beside_cycles", ""},
                 {"beside_time", other_time},
                 {"beside_end_time", other_time}});
    for (std::size_t i = 0; i < std::min(one.rows.size(), other.rows.size()); ++i) {
        table.add(one.rows[i].overshoot);
        for (const Trips* trips : {&one, &other}) {
            const Summary summary = summary_of(*trips, trips->rows[i]);
            table.add(summary.cycles);
            table.add(summary.time);
            table.add(summary.end_time);
        }
    }
    return table;
}

void add_touch(FigurePanel& panel, const Trips& trips, const std::string& which) {
    const double speed = trips.end.end.speed;
    const std::string level =
        fmt::format("speed {:.4g}", speed > 0 ? std::min(trips.point.level, speed) : trips.point.level);
    const std::string& end = trips.end.words;
    std::vector<std::pair<double, TripTime>> map, continued;
    FigureSeries simulated = series_of(which + "simulation alone, until " + end, FigureSeries::Style::circles, 2);
    for (const TripRow& row : trips.rows) {
        const double x = std::abs(row.overshoot);
        if (x == 0) // has no place on the axis
            continue;
        if (row.predicted.ended)
            map.emplace_back(x, row.predicted);
        if (row.continued.ended)
            continued.emplace_back(x, row.continued);
        if (row.simulated && row.simulated->ended)
            simulated.points.push_back({x, row.simulated->time});
    }
    constexpr int disc = 7, triangle = 9; // gnuplot's symbols
    add_trips(panel, map, which + "map, until " + level, 0, triangle);
    add_trips(panel, continued, which + "map, then simulation, until " + end, 1, disc);
    panel.series.push_back(std::move(simulated));
}

void add_fold(FigurePanel& panel, const Trips& trips, const std::string& which) {
    FigureSeries form = series_of(which + "normal form, from far away", FigureSeries::Style::dashed, 3);
    FigureSeries gated = series_of(which + "normal form, from gate to gate", FigureSeries::Style::line, 3);
    FigureSeries simulated = series_of(which + "simulation, until " + trips.end.words, FigureSeries::Style::circles, 4);
    for (const TripRow& row : trips.rows) {
        const Summary summary = summary_of(trips, row);
        form.points.push_back({std::abs(row.overshoot), summary.time});
        gated.points.push_back({std::abs(row.overshoot), row.gate_cycles * trips.point.cycle});
        if (std::isfinite(summary.end_time))
            simulated.points.push_back({std::abs(row.overshoot), summary.end_time});
    }
    panel.series.insert(panel.series.end(), {form, gated, simulated});
}

Figure figure_of(const std::vector<Trips>& all) {
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
    for (const Trips& trips : all) {
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
    std::vector<Trips> all;
    const auto add = [&](const std::string& name, const std::string& option) {
        LossPoint point = loss_point(file, name, arguments.parameter, option);
        AskedEnd end = end_of(point, arguments);
        all.push_back({std::move(point), std::move(end)});
    };
    add(arguments.point, "POINT");
    if (!arguments.beside.empty())
        add(arguments.beside, "--beside");
    const std::vector<double> overshoots = overshoots_of(all.front().point, arguments.overshoots);
    if (!arguments.plot.empty())
        require_drawable(overshoots);
    const InterruptGuard guard;
    bool interrupted = false;
    std::vector<std::string> lacks;
    for (Trips& trips : all) {
        const TripOptions options = options_of(trips.point, arguments);
        for (std::size_t i = 0; i < overshoots.size() && !interrupted; ++i) {
            const bool own = &trips == &all.front();
            interrupted = !add_row(trips, own ? overshoots[i] : trips.point.side * std::abs(overshoots[i]), options);
        }
        lacks.insert(lacks.end(), trips.lacks.begin(), trips.lacks.end());
    }
    if (arguments.plot.empty() || interrupted) {
        const Trips& one = all.front();
        const Table table = all.size() > 1   ? table_of_both(one, all.back())
                            : one.point.fold ? table_of_fold(one)
                                             : table_of_touch(one);
        deliver(table, arguments.output, heading_of(file, one.point, one.end), console);
    } else {
        draw_figure(figure_of(all), arguments.plot, arguments.data);
        console.out << arguments.plot << '\n';
    }
    if (interrupted) {
        console.err << fmt::format("graze: interrupted; {} of {} overshoots are done\n", all.back().rows.size(),
                                   overshoots.size());
        return InterruptGuard::exit_code();
    }
    tell_lacks(lacks, console);
    return lacks.empty() ? exit_success : exit_irregular;
}

} // namespace graze
