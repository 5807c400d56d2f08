#include "program/layout_yield.hpp"
#include "program/drawing.hpp"

#include "graze/base/input_error.hpp"
#include "graze/design/design.hpp"
#include "graze/picture/wafer_map.hpp"
#include "program/commands.hpp"
#include "program/empty_cell.hpp"
#include "program/interrupt.hpp"
#include "program/json_rows.hpp"
#include "program/kept_inputs.hpp"
#include "program/output_file.hpp"
#include "program/process.hpp"
#include "program/trip_location.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace graze {

namespace {

std::string unit_of(const Model& model, const std::string& parameter) {
    const auto place = model.find_parameter(parameter);
    return place ? model.parameters[*place].unit : "";
}

class WaferFacts {
public:
    void add(const std::string& name, double value, const std::string& unit, const std::string& meaning) {
        table_.add(name);
        table_.add(value);
        table_.add(unit);
        table_.add(meaning);
    }
    Table table() { return std::move(table_); }

private:
    Table table_{{{"quantity", ""}, {"value", ""}, {"unit", ""}, {"meaning", ""}}};
};

void add_times(WaferFacts& facts, const WaferYield& yield, const std::string& unit) {
    std::vector<double> times;
    for (const WaferDevice& device : yield.devices)
        if (device.trip_time)
            times.push_back(*device.trip_time);
    if (times.empty() || !yield.overshoot)
        return;
    std::sort(times.begin(), times.end());
    const std::string beyond = fmt::format("{:g} beyond the trip value", *yield.overshoot);
    facts.add("trip_time_least", times.front(), unit, beyond);
    facts.add("trip_time_median", times[times.size() / 2], unit, beyond);
    facts.add("trip_time_greatest", times.back(), unit, beyond);
}

std::string outcome_of(const WaferDevice& device) {
    switch (device.outcome) {
    case DeviceOutcome::found:
        return std::string(class_name(device.found));
    case DeviceOutcome::inadmissible:
        return "something else happens first";
    case DeviceOutcome::failed:
        return device.lumped ? "not found" : "cannot be made";
    case DeviceOutcome::not_made:
        break;
    }
    return "not made";
}

std::string json_of(const DeviceFile& file, const WaferYieldSettings& settings, const Table& facts,
                    const Table& devices) {
    JsonObject report;
    report.add("graze", GRAZE_VERSION);
    report.add("design", file.name);
    report.add("wafers", static_cast<double>(settings.wafers));
    report.add("seed", static_cast<double>(settings.seed));
    report.add("facts", json_rows(facts));
    report.add("devices", json_rows(devices));
    return "{" + report.members() + "}\n";
}

void draw_maps(const WaferYield& yield, const DeviceFile& file, const Design& design, const std::string& folder,
               std::size_t wafers, const Console& console, std::vector<std::string>& written) {
    WaferMapLabels labels;
    labels.control = design.control;
    labels.unit = unit_of(design.model, design.control);
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

Table wafer_device_table(const WaferYield& yield, const Layout& wafer, const Model& model, const std::string& control) {
    std::vector<Table::Column> columns{{"wafer", ""}, {"site", ""}, {"x", "um"}, {"y", "um"}};
    for (const DepartureField& field : departure_fields())
        columns.push_back({fmt::format("more_{}", field.name), field.unit});
    const std::vector<std::string> names{"m", "f0", "zeta", "area", "d", "stop"};
    for (const std::string& name : names)
        columns.push_back({name, unit_of(model, name)});
    columns.push_back({control, unit_of(model, control)});
    columns.push_back({"class", ""});
    columns.push_back({"trip_time", model.time_unit});
    for (const auto& field : device_fields())
        columns.push_back({fmt::format("drawn_{}", field.name), "um"});
    columns.push_back({"drawn_folds", ""});
    Table table(columns);
    for (const WaferDevice& device : yield.devices) {
        table.add(static_cast<double>(device.wafer));
        table.add(static_cast<double>(device.site));
        table.add(device.place.x);
        table.add(device.place.y);
        for (const DepartureField& field : departure_fields())
            table.add(device.departure.*field.departure);
        if (device.lumped)
            for (const auto& [name, value] : parameters_of(*device.lumped, model).set)
                table.add(value);
        else
            for (std::size_t i = 0; i < names.size(); ++i)
                table.add(nothing);
        if (device.outcome == DeviceOutcome::found)
            table.add(device.value);
        else
            table.add(nothing);
        table.add(outcome_of(device));
        if (device.trip_time)
            table.add(*device.trip_time);
        else
            table.add(nothing);
        const DeviceDimensions& drawn = wafer.devices[wafer.sites[device.site - 1]].drawing.dimensions;
        for (const auto& field : device_fields())
            table.add(drawn.*field.member);
        table.add(static_cast<double>(drawn.folds));
    }
    return table;
}

Table wafer_fact_table(const WaferYield& found, const Model& model, const std::string& control, std::size_t wafers) {
    const Yield& yield = found.yield;
    const std::string unit = unit_of(model, control);
    WaferFacts facts;
    facts.add("nominal", yield.nominal, unit, fmt::format("{} at which the drawn device trips", control));
    facts.add("wafers", static_cast<double>(wafers), "", "");
    facts.add("devices", static_cast<double>(yield.made), "", "on all wafers");
    facts.add("devices_found", static_cast<double>(yield.found), "", "with a trip value; what follows is of them");
    for (const auto& [outcome, count] : found.classes)
        facts.add(fmt::format("class_{}", class_name(outcome)), static_cast<double>(count), "",
                  "devices of this class");
    if (yield.mean)
        facts.add("mean", yield.mean->value, unit, "");
    if (yield.deviation)
        facts.add("deviation", yield.deviation->value, unit, "standard deviation");
    facts.add("linear_deviation", found.linear_deviation, unit, "the same by the derivatives alone, of many wafers");
    for (const SpreadEffect& one : found.effects)
        facts.add("effect_" + one.name, one.effect, unit,
                  fmt::format("of {:.4g} {}, as far as {} is linear in it", one.deviation, one.unit, control));
    for (const QuantileEstimate& one : yield.quantiles)
        facts.add(fmt::format("quantile_{:g}", one.share), one.value, unit, "this share lies below");
    if (yield.within)
        facts.add("yield", yield.within->value, "", "share of all devices within what is wanted");
    add_times(facts, found, model.time_unit);
    return facts.table();
}

int layout_yield(const LayoutArguments& arguments, const DeviceFile& file, const Layout& wafer,
                 const Console& console) {
    const Design own = load_design(arguments.design);
    keep_inputs_of(own);
    const Design design = said_of(own, [&] { return design_of_device(own, file); });
    const std::string folder = arguments.folder.empty() ? file.name + "-wafers" : arguments.folder;
    make_folder(folder, "--folder");
    const auto path = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    std::vector<std::string> written{path("wafers.csv"), path("devices.csv"), path("report.json")};
    for (const std::string& one : written)
        KeptInputs::require_none_at(one); // before the work
    const InterruptGuard guard;
    StatusLine line(console, console.terminal);
    const DesignReportOptions options = interactive_options(arguments.jobs, line);
    const std::optional<TripPoint> trip = locate_trip(design, path("results.sqlite"), options);
    WaferYieldSettings settings;
    settings.wafers = *arguments.yield;
    settings.seed = arguments.seed;
    settings.jobs = options.jobs;
    settings.interrupted = options.interrupted;
    settings.progress = [&](std::size_t devices) { options.progress(fmt::format("device {}", devices)); };
    const WaferYield found =
        trip ? said_of(design, [&] { return wafer_yield_of(design, file, wafer, *trip, settings); }) : WaferYield();
    if (!trip || found.yield.interrupted) {
        console.err << "graze: interrupted; nothing but the way to the trip point is kept\n";
        return InterruptGuard::exit_code();
    }
    const Table facts = wafer_fact_table(found, design.model, design.control, settings.wafers);
    const Table devices = wafer_device_table(found, wafer, design.model, design.control);
    write_file(written[0], csv_text(facts));
    write_file(written[1], csv_text(devices));
    write_file(written[2], json_of(file, settings, facts, devices));
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
