#include "graze/grazing/trip_time.hpp"
#include "graze/symbolic/input_error.hpp"
#include "program/commands.hpp"
#include "program/figure.hpp"
#include "program/picture.hpp"
#include "program/quantity.hpp"
#include "program/touching_orbit.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace graze {

namespace {

/// What is known of one overshoot.
struct TripRow {
    double overshoot = 0;
    PredictedTrip predicted;           ///< until the map's level
    TripTime continued;                ///< until the end that was asked for
    std::optional<TripTime> simulated; ///< likewise
};

/// What ends a trip, for people too.
struct AskedEnd {
    TripEnd end;
    std::string words;
};

constexpr std::size_t most_rows = 1000;

[[noreturn]] void refuse_overshoot(const std::string& text, const std::string& what) {
    throw InputError(Place{"--overshoot " + text, 0, 0}, what, "write 1e-3,1e-6 or 1e-2:1e-20");
}

/// A value for each decade from the first to the last.
void add_decades(std::vector<double>& values, double first, double last, const std::string& text) {
    if (!(first * last > 0))
        refuse_overshoot(text, "the ends of the range are not of one sign");
    const double decades = std::abs(std::log10(first / last));
    if (!(decades < most_rows))
        refuse_overshoot(text, "the range is too long");
    const auto count = static_cast<int>(std::floor(decades + 1e-9));
    for (int i = 0; i <= count; ++i)
        // By text, so that powers of ten are what people write.
        values.push_back(first * std::stod(fmt::format("1e{}", std::abs(first) > std::abs(last) ? -i : i)));
}

/// Those asked for, or ten from 1e-2 to 1e-20 of the size of the parameter, on the side with contacts.
std::vector<double> overshoots_of(const TouchingOrbit& found, const std::vector<std::string>& asked) {
    std::vector<double> values;
    for (const std::string& text : split_list(asked)) {
        const std::size_t colon = text.find(':');
        const auto number = [&](const std::string& part) {
            return value_of(found.stored.run.model, part, "--overshoot");
        };
        if (colon == std::string::npos)
            values.push_back(number(text));
        else
            add_decades(values, number(text.substr(0, colon)), number(text.substr(colon + 1)), text);
    }
    if (values.size() > most_rows)
        refuse_overshoot("", fmt::format("{} overshoots are too many", values.size()));
    if (!values.empty())
        return values;
    const double value = std::abs(found.map.contact.touch.parameters[found.parameter->place()]);
    const int size = value > 0 ? static_cast<int>(std::floor(std::log10(value))) : 0;
    const char* sign = *found.map.clearance_rate < 0 ? "" : "-";
    constexpr int least = 20;
    for (int digits = 2; digits <= least; digits += 2)
        values.push_back(std::stod(fmt::format("{}1e{}", sign, size - digits)));
    return values;
}

AskedEnd end_of(const Model& model, const TripArguments& arguments, double level) {
    if (arguments.greatest_speed)
        return {{*arguments.greatest_speed, {}, 0}, fmt::format("speed {:.4g}", *arguments.greatest_speed)};
    if (arguments.until.empty())
        return {{level, {}, 0}, fmt::format("speed {:.4g}", level)};
    if (arguments.until == "end")
        return {{}, "the end"};
    const std::size_t equals = arguments.until.rfind('=');
    if (equals == std::string::npos)
        throw InputError(Place{"--until " + arguments.until, 0, 0}, "it names no level",
                         "write EXPR=LEVEL, such as q=0.9, or end");
    AskedEnd asked{{}, arguments.until};
    asked.end.quantity = requested_quantity(model, arguments.until.substr(0, equals), "--until").value;
    asked.end.level = value_of(model, arguments.until.substr(equals + 1), "--until");
    return asked;
}

/// A number of the table: missing where the end has not come.
double if_ended(const TripTime& trip, double value) {
    return trip.ended ? value : std::numeric_limits<double>::quiet_NaN();
}

Table table_of(const std::vector<TripRow>& rows, const Model& model, const std::string& parameter) {
    const std::string unit = model.parameters[*model.find_parameter(parameter)].unit;
    Table table({{"overshoot", unit},
                 {"first_speed", ""},
                 {"cycles", ""},
                 {"time", model.time_unit},
                 {"end_cycles", ""},
                 {"end_time", model.time_unit},
                 {"ending", ""},
                 {"simulated_time", model.time_unit}});
    for (const TripRow& row : rows) {
        table.add(row.overshoot);
        table.add(row.predicted.first_speed);
        table.add(if_ended(row.predicted, row.predicted.cycles));
        table.add(if_ended(row.predicted, row.predicted.time));
        table.add(if_ended(row.continued, row.continued.cycles));
        table.add(if_ended(row.continued, row.continued.time));
        table.add(row.continued.ending);
        table.add(row.simulated ? if_ended(*row.simulated, row.simulated->time)
                                : std::numeric_limits<double>::quiet_NaN());
    }
    return table;
}

FigureSeries series_of(const std::string& title, FigureSeries::Style style, std::size_t colour) {
    FigureSeries series;
    series.title = title;
    series.style = style;
    series.colour = colour;
    return series;
}

Figure figure_of(const std::vector<TripRow>& rows, const Model& model, const std::string& parameter,
                 const std::string& level, const std::string& end) {
    FigurePanel panel;
    panel.x_label = rows.front().overshoot > 0 ? parameter + " beyond its touch" : parameter + " short of its touch";
    panel.x_unit = model.parameters[*model.find_parameter(parameter)].unit;
    panel.y_label = "time";
    panel.y_unit = model.time_unit;
    panel.logarithmic_x = true;
    panel.roomy_x = panel.roomy_y = true;
    FigureSeries map = series_of("map, until " + level, FigureSeries::Style::dashed, 0);
    FigureSeries continued = series_of("map, then simulation, until " + end, FigureSeries::Style::line, 1);
    FigureSeries simulated = series_of("simulation alone, until " + end, FigureSeries::Style::circles, 2);
    for (const TripRow& row : rows) {
        const double x = std::abs(row.overshoot);
        if (row.predicted.ended)
            map.points.push_back({x, row.predicted.time});
        if (row.continued.ended)
            continued.points.push_back({x, row.continued.time});
        if (row.simulated && row.simulated->ended)
            simulated.points.push_back({x, row.simulated->time});
    }
    panel.series = {map, continued, simulated};
    Figure figure;
    figure.panels.push_back(std::move(panel));
    return figure;
}

JsonObject heading_of(const ResultFile& file, const TouchingOrbit& found, const std::string& parameter, double level,
                      const std::string& end) {
    const OrbitRecord& record = found.stored.record;
    JsonObject heading;
    heading.add("graze", GRAZE_VERSION);
    heading.add("file", file.path());
    heading.add("model", found.stored.run.model.name);
    heading.add("run", found.stored.run.record.name);
    heading.add("number", static_cast<double>(record.number));
    heading.add("label", record.label);
    heading.add("parameter", parameter);
    heading.add("touch", found.map.contact.touch.parameters[found.parameter->place()]);
    heading.add("cycle", found.map.time);
    heading.add("speed", level);
    heading.add("end", end);
    return heading;
}

} // namespace

int trip_command(const TripArguments& arguments, const Console& console) {
    if (!arguments.plot.empty())
        picture_ending(arguments.plot, "--plot", {"svg", "png", "pdf"});
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    const TouchingOrbit found = find_touching_orbit(file, arguments.point, arguments.parameter);
    const Verdict verdict = verdict_of(found.map);
    const Model& model = found.stored.run.model;
    const System system(model);
    double level = 0;
    try {
        level = level_of_map(found.map, verdict);
    } catch (const InputError& error) {
        throw InputError(Place{"POINT", 0, 0}, error.problem(), error.remedy());
    }
    if (!found.parameter || !found.map.clearance_rate || *found.map.clearance_rate == 0)
        throw InputError("nothing is said to move the orbit from its touch", "name a parameter by --parameter NAME");
    const std::string parameter = model.independent_parameters()[found.parameter->place()];
    const AskedEnd asked = end_of(model, arguments, level);
    PredictionOptions prediction;
    prediction.level = level = asked.end.speed > 0 ? std::min(level, asked.end.speed) : level;
    TripOptions options;
    options.cycles = static_cast<double>(arguments.cycles);
    std::vector<TripRow> rows;
    bool all_ended = true;
    for (const double overshoot : overshoots_of(found, arguments.overshoots)) {
        TripRow& row = rows.emplace_back();
        row.overshoot = overshoot;
        row.predicted = predicted_trip(found.map, verdict, overshoot, prediction);
        row.continued =
            continued_trip(system, found.map, *found.parameter, overshoot, row.predicted, asked.end, options);
        if (std::abs(overshoot) >= least_overshoot(found.map, *found.parameter))
            row.simulated = simulated_trip(system, found.map, *found.parameter, overshoot, asked.end, options);
        all_ended = all_ended && row.continued.ended;
    }
    if (arguments.plot.empty()) {
        deliver(table_of(rows, model, parameter), arguments.output,
                heading_of(file, found, parameter, level, asked.words), console);
    } else {
        draw_figure(figure_of(rows, model, parameter, fmt::format("speed {:.4g}", level), asked.words), arguments.plot,
                    arguments.data);
        console.out << arguments.plot << '\n';
    }
    return all_ended ? exit_success : exit_irregular;
}

} // namespace graze
