#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/yield_picture.hpp"
#include "graze/results/point_tolerances.hpp"
#include "program/commands.hpp"
#include "program/drawing.hpp"
#include "program/interrupt.hpp"
#include "program/mpi_workers.hpp"
#include "program/output_file.hpp"
#include "program/status_line.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// The point, and the yield if tolerances were given.
struct Findings : LocatedPoint {
    YieldSettings settings{};
    std::optional<Yield> yield{};
};

void set_yield(Findings& found, const System& system, const ToleranceArguments& arguments, const Console& console,
               Workers* workers) {
    YieldSettings& settings = found.settings;
    for (const std::string& item : split_list(arguments.vary))
        settings.tolerances.push_back(read_tolerance(found, item, "--vary"));
    if (!arguments.within.empty())
        read_interval(settings, found, arguments.within, "--within");
    settings.devices = arguments.devices;
    settings.seed = arguments.seed;
    settings.jobs = threads_beside(workers, arguments.jobs);
    settings.elsewhere = workers ? workers->devices() : nullptr;
    StatusLine line(console, console.terminal);
    settings.progress = [&](std::size_t devices) {
        if (line.is_due())
            line.show(fmt::format("device {} of {}", devices, arguments.devices));
    };
    carry_out(workers, [&](const std::function<bool()>& interrupted) {
        settings.interrupted = interrupted;
        found.yield = with_place({"--vary", 0, 0},
                                 [&] { return yield_of(system, found.point, found.located.control(), settings); });
    });
}

/// The statistics by their names.
JsonObject values_of(const Table& statistics) {
    JsonObject values;
    for (std::size_t row = 0; row < statistics.rows(); ++row) {
        const std::string& name = statistics.text(row, 0);
        values.add(name, statistics.number(row, 1));
        const double low = statistics.number(row, 2), high = statistics.number(row, 3);
        if (std::isfinite(low) || std::isfinite(high)) {
            values.add(name + "_low", low);
            values.add(name + "_high", high);
        }
    }
    return values;
}

JsonObject tolerance_heading(const ResultFile& file, const Findings& found) {
    JsonObject heading = heading_of_point(file, found.stored);
    heading.add("type", short_name(found.point.type));
    heading.add("parameter", found.name);
    heading.add("unit", found.unit);
    heading.add("value", found.located.value());
    if (!found.yield)
        return heading;
    heading.add("seed", static_cast<double>(found.settings.seed));
    heading.add("confidence", found.settings.confidence);
    heading.add("statistics", values_of(yield_table(*found.yield, found.name)));
    std::vector<JsonObject> problems;
    for (const auto& [problem, count] : found.yield->problems) {
        JsonObject& one = problems.emplace_back();
        one.add("problem", problem);
        one.add("devices", static_cast<double>(count));
    }
    heading.add("problems", problems);
    return heading;
}

/// Prints both tables for people; as CSV the derivatives, or the statistics if there are tolerances.
void show(const ResultFile& file, const Findings& found, const OutputArguments& output, const Console& console) {
    std::ostringstream text;
    const Console inner{text, console.err, console.terminal, console.cursor, console.width};
    OutputArguments here = output;
    here.file.clear();
    if (output.format == TableFormat::table)
        text << fmt::format("{} = {:.{}g}{}{}\n\n", found.name, found.located.value(), output.shown_digits(),
                            found.unit.empty() ? "" : " ", found.unit);
    if (output.format != TableFormat::csv || !found.yield)
        deliver(derivative_table(found, &found.settings, found.yield ? &*found.yield : nullptr), here,
                tolerance_heading(file, found), inner);
    if (output.format == TableFormat::table && found.yield)
        text << '\n';
    if (output.format != TableFormat::json && found.yield)
        deliver(yield_table(*found.yield, found.name), here, {}, inner);
    if (output.file.empty()) {
        console.out << text.str();
        require_delivered(console);
    } else {
        write_file(output.file, text.view());
    }
}

/// Prints why devices failed, beside the tables.
void tell_tolerance(const Yield& yield, const Console& console) {
    constexpr std::size_t most = 5;
    for (std::size_t i = 0; i < std::min(most, yield.problems.size()); ++i)
        console.err << fmt::format("graze: {} of {} devices: {}\n", yield.problems[i].second, yield.made,
                                   yield.problems[i].first);
    if (yield.problems.size() > most)
        console.err << fmt::format("graze: {} more reasons; --format json has all\n", yield.problems.size() - most);
}

void require_devices(const ToleranceArguments& arguments) {
    if (arguments.vary.empty() && (!arguments.plot.empty() || !arguments.within.empty()))
        throw InputError("without tolerances all devices are alike", "say what differs: --vary NAME=SIZE");
    if (arguments.plot.empty() && !arguments.data.empty())
        throw InputError("--data keeps the data of a picture, and nothing is drawn", "name one by --plot FILE");
    if (!arguments.plot.empty())
        picture_ending(arguments.plot, "--plot", {"svg", "png", "pdf", "eps"});
}

int find_tolerance(const ToleranceArguments& arguments, const Console& console, std::unique_ptr<Workers> workers) {
    require_devices(arguments);
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    Findings found{located_point(file, arguments.point, arguments.parameter, {"POINT", 0, 0}, {"--parameter", 0, 0})};
    const System system(found.stored.run.model);
    const InterruptGuard guard;
    if (!arguments.vary.empty())
        set_yield(found, system, arguments, console, workers.get());
    workers.reset(); // the rest is for one process
    show(file, found, arguments.output, console);
    if (!found.yield)
        return exit_success;
    tell_tolerance(*found.yield, console);
    if (!arguments.plot.empty() && !found.yield->interrupted)
        draw_figure(yield_picture(*found.yield, found.name, found.unit, found.settings.least, found.settings.greatest),
                    arguments.plot, arguments.data);
    if (found.yield->interrupted) {
        console.err << fmt::format("graze: interrupted; {} of {} devices were made\n", found.yield->made,
                                   arguments.devices);
        return InterruptGuard::exit_code();
    }
    return found.yield->failed > 0 ? exit_irregular : exit_success;
}

} // namespace

int tolerance_command(const ToleranceArguments& arguments, const Console& console) {
    return with_workers(arguments.jobs, [&](std::unique_ptr<Workers> workers) {
        return find_tolerance(arguments, console, std::move(workers));
    });
}

} // namespace graze
