#include "graze/layout/drawn_design.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/design/design_report.hpp"
#include "graze/design/trip_times.hpp"
#include "graze/layout/lumped_model.hpp"
#include "graze/layout/wafer_yield.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// Returns the design with the device of the folder as its first device.
Design with_device(const Design& own, const Model& device) {
    Design result = own;
    result.set.clear();
    for (const Parameter& one : device.parameters) {
        if (!one.value)
            continue;
        result.model.set_parameter(one.name, *one.value);
        if (one.name != own.control)
            result.set.emplace_back(one.name, *one.value);
    }
    return result;
}

/// Finds the designed device's trip point from that of the drawn one.
std::optional<TripPoint> designed_trip(const TripPoint& drawn, const Design& designed) {
    const std::vector<ParameterId> others = parameters_but(drawn.system.model(), drawn.control);
    const std::vector<std::string> names = drawn.system.model().independent_parameters();
    std::vector<double> values;
    const std::vector<double> all = designed.model.parameter_values();
    for (const ParameterId one : others)
        values.push_back(all[designed.model.independent_parameter(names[one.place()]).place()]);
    const LocatedSolution found = LocatedValue(drawn.system, drawn.point, drawn.control, others)(values);
    if (!found.found || !found.admissible)
        return std::nullopt;
    return moved_to(drawn, found.orbit);
}

/// Adds a row to the table that compares designed and drawn values.
void add_row(Table& rows, const std::string& name, double designed, double drawn, const std::string& unit,
             const std::string& text) {
    constexpr double percent = 100;
    rows.add(name, designed, drawn, designed != 0 ? percent * (drawn / designed - 1) : not_a_number, unit, text);
}

void add_quantities(Table& rows, const DesignedDevice& designed) {
    for (const MatchedQuantity& one : designed.matched.quantities)
        add_row(rows, one.parameter, one.designed, one.drawn, one.unit,
                one.met ? fmt::format("by {} = {:.9g} {}", one.number, one.after, one.number_unit)
                        : "not as designed: " + one.reason);
    // Chosen numbers that are not drawn, such as the drive's frequency.
    for (const DesignDimension& one : designed.own.dimensions) {
        if (std::any_of(designed.matched.quantities.begin(), designed.matched.quantities.end(),
                        [&](const MatchedQuantity& quantity) { return quantity.parameter == one.name; }))
            continue;
        const double value =
            designed.device.parameter_values()[designed.device.independent_parameter(one.name).place()];
        add_row(rows, one.name, value, value, one.unit, "not drawn: as designed");
    }
}

/// Whether the drawn device meets the requirements; the grid prevents exact values, by far less than this relative
/// error.
bool has_what_is_wanted(const MetWishes& wishes) {
    constexpr double grid = 1e-2;
    for (std::size_t i = 0; i < wishes.found.wants.size(); ++i) {
        const Want& want = wishes.list.wants[i];
        const FoundWant& found = wishes.found.wants[i];
        const bool is_exact = want.least == want.most;
        if (!found.met &&
            !(is_exact && found.value && std::abs(*found.value - want.least) <= grid * std::abs(want.least)))
            return false;
    }
    return true;
}

void add_wants(Table& rows, const MetWishes& drawn, const std::optional<MetWishes>& designed) {
    for (std::size_t i = 0; i < drawn.found.wants.size(); ++i) {
        const Want& want = drawn.list.wants[i];
        const FoundWant& one = drawn.found.wants[i];
        double before = not_a_number;
        if (designed)
            for (std::size_t k = 0; k < designed->found.wants.size(); ++k)
                if (designed->list.wants[k].name == want.name)
                    before = designed->found.wants[k].value.value_or(not_a_number);
        add_row(rows, "want_" + want.name, before, one.value.value_or(not_a_number), "", words_of(want, one));
    }
}

void add_time(Table& rows, const Design& design, const TripPoint& drawn, const std::optional<TripPoint>& designed,
              const std::function<bool()>& interrupted) {
    TripRequest request = design.trip;
    if (!request.overshoots.empty())
        request.overshoots = {*std::max_element(request.overshoots.begin(), request.overshoots.end())};
    const auto time_of = [&](const TripPoint& trip) {
        const TripTimes times = trip_times(trip, trip.point.solution.orbit, class_at(trip), request, interrupted);
        const TripTime* best = times.rows.empty() ? nullptr : times.rows.front().best();
        return std::pair(best ? best->time : not_a_number, times.rows.empty() ? 0 : times.rows.front().overshoot);
    };
    const auto [time, overshoot] = time_of(drawn);
    if (std::isfinite(time))
        add_row(rows, fmt::format("trip_time_{:.3g}", std::abs(overshoot)),
                designed ? time_of(*designed).first : not_a_number, time, drawn.system.model().time_unit,
                "at that overshoot");
}

} // namespace

std::optional<DrawnDesign> drawn_design(const DesignedDevice& designed, const std::string& results,
                                        const DesignReportOptions& options) {
    const Design found = with_device(designed.own, designed.device);
    Design drawn = with_place(found.approach.place, [&] { return design_of_device(found, designed.matched.file); });
    drawn.dimensions = found.dimensions; // they are part of the requirements' table
    const std::optional<TripPoint> trip = locate_trip(drawn, results, options);
    if (!trip)
        return std::nullopt;
    const std::optional<TripPoint> before = designed_trip(*trip, found);
    WishesOptions wishing;
    wishing.jobs = options.jobs;
    wishing.elsewhere = options.elsewhere;
    wishing.interrupted = options.interrupted;
    const MetWishes wishes = with_place(drawn.approach.place, [&] { return wishes_at(drawn, *trip, wishing); });
    std::optional<MetWishes> wishes_before;
    if (before)
        wishes_before = with_place(found.approach.place, [&] { return wishes_at(found, *before, wishing); });
    Table rows({{"quantity", ""}, {"designed", ""}, {"drawn", ""}, {"percent", ""}, {"unit", ""}, {"meaning", ""}});
    add_quantities(rows, designed);
    const Model& model = trip->system.model();
    const std::string unit = model.parameter_unit(designed.own.control);
    const GrazingOutcome outcome = class_at(*trip).outcome;
    add_row(rows, "trip_value", before ? before->value() : not_a_number, trip->value(), unit,
            fmt::format("of {}, at {} of run '{}'", designed.own.control, trip->label, trip->run));
    rows.add("class", before ? class_name(class_at(*before).outcome) : "not found", class_name(outcome), not_a_number,
             "", "");
    add_time(rows, designed.own, *trip, before, options.interrupted);
    add_wants(rows, wishes, wishes_before);
    if (options.interrupted && options.interrupted())
        return std::nullopt;
    return DrawnDesign{std::move(rows), designed.matched.is_met() && has_what_is_wanted(wishes)};
}

ParameterFile solved_numbers(const DesignedDevice& designed) {
    ParameterFile numbers;
    numbers.text =
        fmt::format("What was solved for, to be given to the device again: the design {}.", designed.own.name);
    for (const MatchedQuantity& one : designed.matched.quantities)
        numbers.set.emplace_back(one.number.substr(one.number.find('.') + 1), one.after);
    return numbers;
}

ParameterFile drawn_parameters(const DesignedDevice& designed) {
    ParameterFile parameters = parameters_of(lumped_model_of(designed.matched.file), designed.own.model);
    parameters.text = fmt::format("The device of the design {}, as it is drawn and after the etch.", designed.own.name);
    return parameters;
}

} // namespace graze
