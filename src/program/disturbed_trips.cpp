#include "program/commands.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/picture/trip_series.hpp"
#include "graze/results/trip_table.hpp"
#include "graze/trip/disturbed_trip.hpp"
#include "graze/trip/noisy_trip.hpp"
#include "program/asked_trip.hpp"
#include "program/drawing.hpp"
#include "program/interrupt.hpp"
#include "program/status_line.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// The question about a disturbance, and its answer as a table and a figure.
struct AskedTrips {
    const TripArguments& arguments;
    const Console& console;
    AskedTrip trip;
    const LossPoint& point = trip.point;
    Table table{};
    Figure figure{};
    std::vector<std::string> lacks{}; ///< messages about trips without an end
    bool interrupted = false;
    std::size_t done = 0, wanted = 0;

    std::string option(const char* name) const { return std::string("--") + name; }
    double cycles(long usual) const { return static_cast<double>(arguments.cycles.value_or(usual)); }
    double number(const std::string& text, const char* name) const {
        return value_of(point.model(), text, option(name));
    }
};

/// The orbit at the value that is disturbed.
TripOrigin resting_origin(const AskedTrips& asked, const char* option) {
    if (asked.arguments.at.empty())
        throw InputError(Place{asked.option(option), 0, 0}, "nothing says where the motion rests",
                         fmt::format("give the value of {} that is disturbed: --at VALUE", asked.point.name));
    const double value = asked.number(asked.arguments.at, "at");
    return with_place({"--at", 0, 0}, [&] { return trip_origin(asked.point, value); });
}

TripOptions options_of(const AskedTrips& asked) {
    TripOptions options;
    constexpr long usual = 2000;
    options.cycles = asked.cycles(usual);
    options.interrupted = [] { return InterruptGuard::requested(); };
    return options;
}

/// Notes how many rows were asked for and how many are done.
void note_rows(AskedTrips& asked, std::size_t wanted, std::size_t done) {
    asked.wanted = wanted;
    asked.done = done;
    asked.interrupted = done < wanted;
}

void ramp(AskedTrips& asked) {
    const LossPoint& point = asked.point;
    const std::vector<double> rates = numbers_by_decades(point.model(), split_list(asked.arguments.ramps), "--ramp");
    const std::vector<RampRow> rows = with_place({"--ramp", 0, 0}, [&] {
        const auto from =
            asked.arguments.at.empty() ? std::nullopt : std::optional(asked.number(asked.arguments.at, "at"));
        return ramped_trips(point, rates, from, asked.trip.end.end, options_of(asked));
    });
    note_rows(asked, rates.size(), rows.size());
    asked.lacks = unfinished_trips(rows, "give more --cycles, or another end by --until");
    asked.table = ramp_table(point, rows);
    asked.figure = ramp_figure(point, rows, asked.trip.end.words);
}

void wave(AskedTrips& asked) {
    const LossPoint& point = asked.point;
    const TripOrigin origin = resting_origin(asked, "wave");
    constexpr double usual = 100; // cycles
    const double period = asked.arguments.wave_period.value_or(usual) * origin.cycle;
    const std::vector<double> amplitudes =
        numbers_by_decades(point.model(), split_list(asked.arguments.waves), "--wave");
    const std::vector<TripTime> trips = with_place({"--wave", 0, 0}, [&] {
        return swung_trips(point, origin, amplitudes, period, asked.trip.end.end, options_of(asked));
    });
    note_rows(asked, amplitudes.size(), trips.size());
    asked.lacks = unfinished_trips(amplitudes, trips);
    asked.table = wave_table(point, amplitudes, trips);
    asked.figure = wave_figure(point, origin, amplitudes, trips, asked.trip.end.words);
}

NoiseSettings settings_of(const AskedTrips& asked) {
    NoiseSettings settings;
    constexpr long usual = 100;
    settings.cycles = static_cast<std::size_t>(asked.arguments.cycles.value_or(usual));
    settings.memory = asked.arguments.memory.value_or(0);
    settings.motions = asked.arguments.motions;
    settings.seed = asked.arguments.seed;
    settings.jobs = threads_for(asked.arguments.jobs);
    settings.interrupted = [] { return InterruptGuard::requested(); };
    return settings;
}

void noise(AskedTrips& asked) {
    const LossPoint& point = asked.point;
    const TripOrigin origin = resting_origin(asked, "noise");
    const NoiseSettings settings = settings_of(asked);
    const std::vector<double> levels = numbers_by_decades(point.model(), split_list(asked.arguments.noises), "--noise");
    StatusLine line(asked.console, asked.console.terminal);
    const auto progress = [&](std::size_t level, std::size_t motions) {
        if (line.is_due())
            line.show(
                fmt::format("level {} of {}, motion {} of {}", level + 1, levels.size(), motions, settings.motions));
    };
    const std::vector<NoisyTrips> all = with_place(
        {"--noise", 0, 0}, [&] { return noisy_trips(point, origin, levels, asked.trip.end.end, settings, progress); });
    note_rows(asked, levels.size(), all.size());
    asked.lacks = unfinished_trips(levels, all);
    asked.table = noise_table(point, levels, all);
    asked.figure = noise_figure(point, levels, all, settings);
}

JsonObject disturbed_heading(const ResultFile& file, const AskedTrips& asked) {
    JsonObject heading = heading_of(file, asked.trip);
    const TripArguments& arguments = asked.arguments;
    if (!arguments.at.empty())
        heading.add("at", asked.number(arguments.at, "at"));
    if (!arguments.noises.empty()) {
        const NoiseSettings settings = settings_of(asked);
        heading.add("memory", settings.memory);
        heading.add("cycles", static_cast<double>(settings.cycles));
        heading.add("seed", static_cast<double>(settings.seed));
        heading.add("confidence", settings.confidence);
    }
    return heading;
}

/// Refuses options that have no effect where the parameter changes in time.
void require_together(const TripArguments& arguments) {
    const auto refuse = [](bool given, const char* option, const char* problem, const char* remedy) {
        if (given)
            throw InputError(Place{option, 0, 0}, problem, remedy);
    };
    const int kinds =
        (arguments.ramps.empty() ? 0 : 1) + (arguments.waves.empty() ? 0 : 1) + (arguments.noises.empty() ? 0 : 1);
    refuse(kinds > 1, "--ramp, --wave, --noise", "only one of them is done at a time", "choose one of them");
    const char* steady = "the parameter changes in time here, and begins before the point";
    refuse(!arguments.overshoots.empty(), "--overshoot", steady, "leave it out");
    refuse(!arguments.disturbances.empty(), "--disturbance", steady, "leave it out");
    refuse(!arguments.beside.empty(), "--beside", "only overshoots of two points are put side by side", "leave it out");
    refuse(arguments.memory && arguments.noises.empty(), "--memory", "nothing is random", "give --noise LEVELS");
    refuse(arguments.wave_period && arguments.waves.empty(), "--wave-period", "nothing swings",
           "give --wave AMPLITUDES");
}

} // namespace

bool is_disturbed(const TripArguments& arguments) {
    return !(arguments.ramps.empty() && arguments.waves.empty() && arguments.noises.empty());
}

int disturbed_trips(const ResultFile& file, const TripArguments& arguments, const Console& console) {
    require_together(arguments);
    AskedTrip trip = asked_trip(file, arguments.point, arguments, "POINT");
    if (trip.point.fold && !trip.end.given)
        throw InputError(Place{"POINT", 0, 0}, "nothing says where a motion ends that has left a fold",
                         "give --until EXPR=LEVEL or --until end");
    AskedTrips asked{.arguments = arguments, .console = console, .trip = std::move(trip)};
    const InterruptGuard guard;
    if (!arguments.ramps.empty())
        ramp(asked);
    else if (!arguments.waves.empty())
        wave(asked);
    else
        noise(asked);
    if (arguments.plot.empty() || asked.interrupted) {
        deliver(asked.table, arguments.output, disturbed_heading(file, asked), console);
    } else {
        draw_figure(asked.figure, arguments.plot, arguments.data);
        console.out << arguments.plot << '\n';
    }
    if (asked.interrupted) {
        console.err << fmt::format("graze: interrupted; {} of {} rows are done\n", asked.done, asked.wanted);
        return InterruptGuard::exit_code();
    }
    tell_lacks(asked.lacks, console);
    return asked.lacks.empty() ? exit_success : exit_irregular;
}

} // namespace graze
