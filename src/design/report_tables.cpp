#include "base/enumerator_name.hpp"
#include "base/special_numbers.hpp"
#include "graze/design/design_report.hpp"
#include "graze/results/json_object.hpp"
#include "graze/results/table_text.hpp"
#include "graze/sweep/attractor.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace {

/// The table of facts.
class FactRows {
public:
    void add(const std::string& name, double value, const std::string& unit, const std::string& meaning) {
        table_.add(name, value, unit, meaning);
    }
    void add(const std::string& name, const std::optional<double>& value, const std::string& unit,
             const std::string& meaning) {
        if (value)
            add(name, *value, unit, meaning);
    }
    void add(const std::string& name, std::string_view value, const std::string& meaning) {
        table_.add(name, value, "", meaning);
    }
    Table take() { return std::move(table_); }

private:
    Table table_{{{"quantity", ""}, {"value", ""}, {"unit", ""}, {"meaning", ""}}};
};

/// @param trip optional TripTime, or a prediction of one
double if_ended(const auto& trip, double TripTime::*number) {
    return trip && trip->ended ? (*trip).*number : not_a_number;
}

double value_of(const MappedValue& one) {
    return one.found ? one.value : not_a_number;
}

std::string_view name_of_class(const MappedValue& one) {
    return !one.found ? "not found" : !one.admissible ? "inadmissible" : class_name(one.outcome);
}

/// Adds the first and the nearest earlier point that changes the motion.
void add_earlier(FactRows& facts, const TripPoint& trip, const DesignReport& report, const std::string& unit) {
    const EarlierPoint *first = nullptr, *nearest = nullptr;
    for (const EarlierPoint& one : trip.earlier) {
        if (!one.changes)
            continue;
        if (!first)
            first = &one;
        if (!nearest || std::abs(one.value - report.value) < std::abs(nearest->value - report.value))
            nearest = &one;
    }
    if (!first) {
        facts.add("earlier", "none", "nothing happens on the branch before");
        return;
    }
    facts.add("earlier", first->value, unit,
              fmt::format("{} comes first: {} ({})", first->label, name_of(first->type), first->run));
    facts.add("clear", std::abs(nearest->value - report.value), unit,
              fmt::format("distance from {}, the nearest before it", nearest->label));
}

void add_times(FactRows& facts, const DesignReport& report, const Model& model, const std::string& until) {
    if (!report.times.reason.empty())
        facts.add("trip_time", "none", report.times.reason);
    for (const OvershootTrip& row : report.times.rows)
        if (const TripTime* best = row.best())
            facts.add(
                fmt::format("trip_time_{:.3g}", std::abs(row.overshoot)), best->time, model.time_unit,
                fmt::format("until {} at that overshoot ({})", until == "end" ? best->ending : until,
                            row.simulated && best == &*row.simulated ? "simulated" : "by the map, then simulated"));
}

void add_yield_rows(FactRows& facts, const DesignReport& report, const Design& design, const std::string& unit) {
    if (!report.yield) {
        if (!report.no_yield.empty())
            facts.add("yield", "none", report.no_yield);
        return;
    }
    const Yield& yield = *report.yield;
    facts.add("devices", static_cast<double>(yield.made), "", "made with the tolerances");
    facts.add("devices_found", static_cast<double>(yield.found), "", "that trip at a value that was found");
    if (yield.deviation)
        facts.add("deviation", yield.deviation->value, unit, "standard deviation of the trip value over devices");
    facts.add("linear_deviation", yield.linear_deviation, unit, "the same by the derivatives alone");
    if (yield.within) {
        facts.add("yield", yield.within->value, "", "share of devices within what is wanted");
        facts.add("yield_low", yield.within->low, "", "limits of confidence, 95 percent");
        facts.add("yield_high", yield.within->high, "", "");
    }
    facts.add("linear_yield", yield.linear_within, "", "the same by the derivatives alone");
    if (!yield.contributions.empty()) {
        const Contribution& first = yield.contributions.front();
        for (const DesignDimension& one : design.dimensions)
            if (one.parameter == first.parameter)
                facts.add("most_sensitive", one.name,
                          fmt::format("causes {:.3g} percent of the variance", 100 * first.share));
    }
}

/// Adds whether the requirements are met, and which are not.
void add_wishes(FactRows& facts, const MetWishes& wishes) {
    facts.add("wishes", name_of(wishes.found.outcome),
              wishes.found.reason.empty() ? "the device has all that is wanted" : wishes.found.reason);
    for (std::size_t i = 0; i < wishes.found.wants.size(); ++i) {
        const Want& want = wishes.list.wants[i];
        const FoundWant& one = wishes.found.wants[i];
        if (one.value)
            facts.add("want_" + want.name, *one.value, "", words_of(want, one));
        else
            facts.add("want_" + want.name, "none", words_of(want, one));
    }
}

std::string_view yes_or_no(bool yes) {
    return yes ? "yes" : "no";
}

/// A cell for a bound; empty if it is infinite.
double bound_of(double value) {
    return std::isfinite(value) ? value : not_a_number;
}

Table wishes_table(const MetWishes& wishes) {
    Table table(
        {{"what", ""}, {"least", ""}, {"greatest", ""}, {"value", ""}, {"met", ""}, {"binds", ""}, {"weight", ""}});
    for (std::size_t i = 0; i < wishes.found.wants.size(); ++i) {
        const FoundWant& one = wishes.found.wants[i];
        const Want& want = wishes.list.wants[i];
        table.add(want.name, bound_of(want.least), bound_of(want.most), one.value, yes_or_no(one.met),
                  yes_or_no(one.binds), one.weight);
    }
    for (std::size_t i = 0; i < wishes.found.dimensions.size(); ++i) {
        const FoundDimension& one = wishes.found.dimensions[i];
        const Dimension& range = wishes.list.dimensions[i];
        table.add(range.name, bound_of(range.lowest), bound_of(range.highest), one.value, "", yes_or_no(one.binds),
                  one.weight);
    }
    return table;
}

Table earlier_table(const TripPoint& trip, const std::string& control, const std::string& unit) {
    Table table({{"run", ""}, {"label", ""}, {"type", ""}, {control, unit}, {"changes", ""}, {"detail", ""}});
    for (const EarlierPoint& one : trip.earlier)
        table.add(one.run, one.label, name_of(one.type), one.value, yes_or_no(one.changes), one.detail);
    return table;
}

Table sensitivity_table(const Design& design, const DesignReport& report, const std::string& unit) {
    Table table({{"parameter", ""},
                 {"value", ""},
                 {"unit", ""},
                 {"d" + design.control, unit},
                 {"relative", ""},
                 {"deviation", ""},
                 {"effect", unit},
                 {"share", ""}});
    for (const Sensitivity& one : report.sensitivities) {
        double deviation = not_a_number, effect = not_a_number, share = not_a_number;
        if (report.yield) {
            for (const Tolerance& tolerance : report.yield_settings.tolerances)
                if (tolerance.parameter == one.parameter)
                    deviation = tolerance.deviation();
            for (const Contribution& part : report.yield->contributions)
                if (part.parameter == one.parameter)
                    effect = part.deviation, share = part.share;
        }
        table.add(one.name, one.value, one.unit, one.derivative, one.relative, deviation, effect, share);
    }
    return table;
}

Table times_table(const DesignReport& report, const std::string& unit, const std::string& time_unit) {
    Table table({{"overshoot", unit},
                 {"first_speed", ""},
                 {"cycles", ""},
                 {"time", time_unit},
                 {"end_cycles", ""},
                 {"end_time", time_unit},
                 {"ending", ""},
                 {"simulated_time", time_unit}});
    for (const OvershootTrip& row : report.times.rows) {
        table.add(row.overshoot, row.continued ? row.predicted->first_speed : not_a_number,
                  if_ended(row.predicted, &TripTime::cycles), if_ended(row.predicted, &TripTime::time),
                  if_ended(row.continued, &TripTime::cycles), if_ended(row.continued, &TripTime::time),
                  row.continued   ? row.continued->ending
                  : row.simulated ? row.simulated->ending
                                  : "",
                  if_ended(row.simulated, &TripTime::time));
    }
    return table;
}

Table tuning_table(const Tuning& tuning, const Design& design, const DesignDimension& stop, const std::string& unit) {
    Table table({{design.control, unit}, {stop.name, stop.unit}, {"usable", ""}, {"problem", ""}});
    for (const TuningPoint& one : tuning.points) {
        const bool usable = one.value >= tuning.least && one.value <= tuning.greatest;
        table.add(one.value, one.found ? one.position : not_a_number, yes_or_no(usable), one.problem);
    }
    return table;
}

Table device_table(const Yield& yield, const std::string& control, const std::string& unit) {
    constexpr std::string_view outcomes[] = {"found", "inadmissible", "failed", "not made"}; // of DeviceOutcome
    Table table({{"device", ""}, {control, unit}, {"linear", unit}, {"outcome", ""}});
    for (std::size_t i = 0; i < yield.devices.size(); ++i) {
        const Device& device = yield.devices[i];
        table.add(static_cast<double>(i + 1), device.outcome == DeviceOutcome::found ? device.value : not_a_number,
                  device.linear, enumerator_name(outcomes, device.outcome, "not made"));
    }
    return table;
}

} // namespace

Table facts_of(const Design& design, const TripPoint& trip, const DesignReport& report) {
    const Model& model = trip.system.model();
    const std::string unit = model.parameter_unit(design.control);
    const Orbit& orbit = trip.point.solution.orbit;
    FactRows facts;
    if (report.wishes)
        add_wishes(facts, *report.wishes);
    for (const DesignDimension& one : design.dimensions)
        facts.add(one.name, orbit.parameters[one.parameter.place()], one.unit, one.text);
    facts.add("trip_value", report.value, unit,
              fmt::format("of {}, at {} of run '{}'", design.control, trip.label, trip.run));
    facts.add("class", class_name(report.found.outcome),
              report.found.reason.empty() ? fmt::format("at a {}", name_of(trip.point.type)) : report.found.reason);
    for (const DesignDimension& one : design.dimensions)
        for (const Sensitivity& by : report.sensitivities)
            if (by.parameter == one.parameter)
                facts.add("sensitivity_" + one.name, by.relative, "",
                          fmt::format("percents of the trip value for one of {}", one.name));
    if (report.found.map && report.found.map->exists()) {
        facts.add("next_contact", static_cast<double>(report.found.verdict.next_contact), "",
                  "cycles from one contact to the next; 0 where they do not grow");
        facts.add("speed_factor", report.found.verdict.speed_factor, "",
                  "speed of the first contact by overshoot^(1/2)");
    }
    facts.add("cycle", orbit.period(), model.time_unit, "time of one");
    add_earlier(facts, trip, report, unit);
    add_times(facts, report, model, design.trip.until);
    if (report.reset.value) {
        facts.add("reset_value", *report.reset.value, unit,
                  report.reset.lost_at
                      ? fmt::format("by simulation: the tripped motion ({}) is still there{}", report.reset.motion,
                                    report.reset.motion == name_of(Label::equilibrium)
                                        ? ""
                                        : "; on other ways down it may be lost sooner or later")
                      : fmt::format("the tripped motion is lost there, by a {}", report.reset.how));
        if (report.reset.lost_at)
            facts.add("reset_lost", *report.reset.lost_at, unit, report.reset.how);
        facts.add("hysteresis", report.reset.hysteresis(report.value), unit, "trip value less reset value");
    } else {
        facts.add("reset_value", "none", report.reset.reason);
    }
    if (report.tuning) {
        facts.add("tuned_least", report.tuning->least, unit, "by the adjustable stop; " + report.tuning->ends_below);
        facts.add("tuned_greatest", report.tuning->greatest, unit,
                  "by the adjustable stop; " + report.tuning->ends_above);
    } else if (!report.no_tuning.empty()) {
        facts.add("tuning", "none", report.no_tuning);
    }
    add_yield_rows(facts, report, design, unit);
    facts.add("trial", name_of(report.trial.outcome),
              report.trial.reason.empty() ? "simulation on both sides of the trip value" : report.trial.reason);
    facts.add("trial_below", report.trial.below, unit, report.trial.seen_below);
    facts.add("trial_above", report.trial.above, unit, report.trial.seen_above);
    return facts.take();
}

std::vector<NamedTable> tables_of(const Design& design, const TripPoint& trip, const DesignReport& report) {
    const Model& model = trip.system.model();
    const std::string unit = model.parameter_unit(design.control);
    std::vector<NamedTable> tables;
    tables.push_back({"facts", facts_of(design, trip, report)});
    tables.push_back({"sensitivities", sensitivity_table(design, report, unit)});
    if (report.wishes)
        tables.push_back({"wishes", wishes_table(*report.wishes)});
    tables.push_back({"earlier", earlier_table(trip, design.control, unit)});
    tables.push_back({"trip-times", times_table(report, unit, model.time_unit)});
    for (const DimensionCurve& curve : report.curves) {
        const DesignDimension& one = design.dimensions[curve.dimension];
        Table table({{one.name, one.unit}, {design.control, unit}, {"class", ""}, {"problem", ""}});
        for (const MappedValue& point : curve.points)
            table.add(point.x, value_of(point), name_of_class(point), point.problem);
        tables.push_back({"curve-" + one.name, std::move(table)});
    }
    for (const DimensionPlane& plane : report.planes) {
        const DesignDimension &x = design.dimensions[plane.across], &y = design.dimensions[plane.up];
        Table table({{x.name, x.unit}, {y.name, y.unit}, {design.control, unit}, {"class", ""}, {"problem", ""}});
        for (const MappedValue& point : plane.points)
            table.add(point.x, point.y, value_of(point), name_of_class(point), point.problem);
        tables.push_back({fmt::format("plane-{}-{}", x.name, y.name), std::move(table)});
    }
    if (report.tuning)
        tables.push_back({"tuning", tuning_table(*report.tuning, design, design.dimensions[*design.adjustable], unit)});
    if (report.yield)
        tables.push_back({"devices", device_table(*report.yield, design.control, unit)});
    return tables;
}

std::string report_json(const Design& design, const std::vector<NamedTable>& tables, const std::string& version) {
    JsonObject report;
    report.add("graze", version);
    report.add("design", design.name);
    report.add("model", design.model.name);
    report.add("control", design.control);
    for (const NamedTable& table : tables)
        if (!table.name.starts_with("plane-") && table.name != "devices")
            report.add(table.name, json_rows(table.table));
    return "{" + report.members() + "}\n";
}

} // namespace graze
