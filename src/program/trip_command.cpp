#include "graze/base/input_error.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/trip_series.hpp"
#include "graze/results/trip_table.hpp"
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
    std::vector<double> values = numbers_by_decades(point.model(), split_list(asked), "--overshoot");
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
        const std::vector<std::string> here =
            unfinished_trips(all.back(), "give more --cycles, or another end by --until");
        lacks.insert(lacks.end(), here.begin(), here.end());
    }
    const bool interrupted = all.front().interrupted || all.back().interrupted;
    if (arguments.plot.empty() || interrupted) {
        const OvershootTrips& one = all.front();
        const Table table = all.size() > 1 ? trip_table(one, all.back()) : trip_table(one);
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
