#include "graze/layout/wafer_tables.hpp"

#include "base/special_numbers.hpp"
#include "graze/layout/lumped_model.hpp"
#include "graze/results/json_object.hpp"
#include "graze/results/table_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace graze {

namespace {

void add_times(Table& facts, const WaferYield& yield, const std::string& unit) {
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

} // namespace

Table wafer_device_table(const WaferYield& yield, const Layout& wafer, const Model& model, const std::string& control) {
    std::vector<Table::Column> columns{{"wafer", ""}, {"site", ""}, {"x", "um"}, {"y", "um"}};
    for (const DepartureField& field : departure_fields())
        columns.push_back({fmt::format("more_{}", field.name), field.unit});
    const std::vector<std::string> names{"m", "f0", "zeta", "area", "d", "stop"};
    for (const std::string& name : names)
        columns.push_back({name, model.parameter_unit(name)});
    columns.push_back({control, model.parameter_unit(control)});
    columns.push_back({"class", ""});
    columns.push_back({"trip_time", model.time_unit});
    for (const auto& field : device_fields())
        columns.push_back({fmt::format("drawn_{}", field.name), "um"});
    columns.push_back({"drawn_folds", ""});
    Table table(columns);
    for (const WaferDevice& device : yield.devices) {
        table.add(static_cast<double>(device.wafer), static_cast<double>(device.site), device.place.x, device.place.y);
        for (const DepartureField& field : departure_fields())
            table.add(device.departure.*field.departure);
        if (device.lumped)
            for (const auto& [name, value] : parameters_of(*device.lumped, model).set)
                table.add(value);
        else
            for (std::size_t i = 0; i < names.size(); ++i)
                table.add(not_a_number);
        table.add(device.outcome == DeviceOutcome::found ? device.value : not_a_number, outcome_of(device),
                  device.trip_time.value_or(not_a_number));
        const DeviceDimensions& drawn = wafer.devices[wafer.sites[device.site - 1]].drawing.dimensions;
        for (const auto& field : device_fields())
            table.add(drawn.*field.member);
        table.add(static_cast<double>(drawn.folds));
    }
    return table;
}

Table wafer_fact_table(const WaferYield& found, const Model& model, const std::string& control, std::size_t wafers) {
    const Yield& yield = found.yield;
    const std::string unit = model.parameter_unit(control);
    Table facts({{"quantity", ""}, {"value", ""}, {"unit", ""}, {"meaning", ""}});
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
    return facts;
}

std::string wafer_report_json(const std::string& design, const WaferYieldSettings& settings, const Table& facts,
                              const Table& devices, const std::string& version) {
    JsonObject report;
    report.add("graze", version);
    report.add("design", design);
    report.add("wafers", static_cast<double>(settings.wafers));
    report.add("seed", static_cast<double>(settings.seed));
    report.add("facts", json_rows(facts));
    report.add("devices", json_rows(devices));
    return "{" + report.members() + "}\n";
}

} // namespace graze
