#include "program/layout_outputs.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/design/design.hpp"
#include "graze/design/design_report.hpp"
#include "graze/layout/wafer_tables.hpp"
#include "graze/picture/wafer_map.hpp"
#include "program/commands.hpp"
#include "program/design_progress.hpp"
#include "program/drawing.hpp"
#include "program/interrupt.hpp"
#include "program/kept_inputs.hpp"
#include "program/output_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <map>

namespace graze {

namespace {

void draw_maps(const WaferYield& yield, const DeviceFile& file, const Design& design, const std::string& folder,
               std::size_t wafers, const Console& console, std::vector<std::string>& written) {
    WaferMapLabels labels;
    labels.control = design.control;
    labels.unit = design.model.parameter_unit(design.control);
    labels.least = design.least_usable();
    labels.greatest = design.greatest_usable();
    labels.title = fmt::format("{}: {} at which each device trips{}", file.name, design.control,
                               labels.least || labels.greatest ? "; ringed: as wanted" : "");
    if (wafers > most_wafers_drawn)
        labels.title += fmt::format(" (the first {} of {} wafers)", most_wafers_drawn, wafers);
    try {
        for (const char* name : {"map.svg", "map.png"}) {
            const std::string path = (std::filesystem::path(folder) / name).string();
            draw_wafer_map(yield, file.wafer, labels, path);
            written.push_back(path);
        }
    } catch (const InputError& error) {
        console.err << fmt::format("graze: warning: the map was not drawn: {}\n", error.what());
    }
}

void tell_problems(const WaferYield& yield, const Console& console) {
    std::map<std::string, std::size_t> counts;
    for (const WaferDevice& device : yield.devices)
        if (!device.problem.empty())
            ++counts[device.problem];
    for (const auto& [problem, count] : yield.yield.problems)
        console.err << fmt::format("graze: {} of {} devices: {}\n", count, yield.yield.made, problem);
    if (!counts.empty())
        console.err << fmt::format("graze: of one that cannot be made {}\n", counts.begin()->first);
}

} // namespace

int layout_yield(const LayoutArguments& arguments, const DeviceFile& file, const Layout& wafer, const Console& console,
                 Workers* workers) {
    const Design own = load_design(arguments.design);
    keep_inputs_of(own);
    const Design design = with_place(own.approach.place, [&] { return design_of_device(own, file); });
    const std::string folder = arguments.folder.empty() ? file.name + "-wafers" : arguments.folder;
    make_folder(folder, "--folder");
    const auto path = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    std::vector<std::string> written{path("wafers.csv"), path("devices.csv"), path("report.json")};
    for (const std::string& one : written)
        KeptInputs::require_none_at(one); // before the computation
    const InterruptGuard guard;
    StatusLine line(console, console.terminal);
    DesignReportOptions options = interactive_options(arguments.jobs, line, workers);
    WaferYieldSettings settings;
    settings.wafers = *arguments.yield;
    settings.seed = arguments.seed;
    settings.jobs = options.jobs;
    settings.elsewhere = options.elsewhere;
    settings.progress = [&](std::size_t devices) { options.progress(fmt::format("device {}", devices)); };
    std::optional<WaferYield> made;
    carry_out(workers, [&](const std::function<bool()>& must_stop) {
        options.interrupted = settings.interrupted = must_stop;
        if (const std::optional<TripPoint> trip = locate_trip(design, path("results.sqlite"), options))
            made =
                with_place(design.approach.place, [&] { return wafer_yield_of(design, file, wafer, *trip, settings); });
    });
    if (!made || made->yield.interrupted) {
        console.err << "graze: interrupted; nothing but the way to the trip point is kept\n";
        return InterruptGuard::exit_code();
    }
    const WaferYield& found = *made;
    const Table facts = wafer_fact_table(found, design.model, design.control, settings.wafers);
    const Table devices = wafer_device_table(found, wafer, design.model, design.control);
    write_file(written[0], csv_text(facts));
    write_file(written[1], csv_text(devices));
    write_file(written[2], wafer_report_json(file.name, settings, facts, devices, GRAZE_VERSION));
    draw_maps(found, file, design, folder, settings.wafers, console, written);
    deliver(facts, arguments.output, {}, console);
    if (arguments.output.format == TableFormat::table)
        for (const std::string& one : written)
            console.out << one << '\n';
    if (settings.wafers > most_wafers_drawn)
        console.err << fmt::format("graze: the map shows the first {} of {} wafers; devices.csv has all\n",
                                   most_wafers_drawn, settings.wafers);
    tell_problems(found, console);
    return found.yield.failed > 0 ? exit_irregular : exit_success;
}

} // namespace graze
