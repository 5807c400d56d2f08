#include "graze/results/point_tolerances.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/model/named_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace graze {

namespace {

/// Rows of a table of statistics.
class StatisticRows {
public:
    void add(const std::string& name, double value, double low, double high, const std::string& meaning) {
        table.add(name, value, low, high, meaning);
    }
    void add(const std::string& name, double value, const std::string& meaning) {
        add(name, value, not_a_number, not_a_number, meaning);
    }
    void add(const std::string& name, const std::optional<ConfidenceInterval>& one, const std::string& meaning) {
        if (one)
            add(name, one->value, one->low, one->high, meaning);
    }
    Table table{{{"quantity", ""}, {"value", ""}, {"low", ""}, {"high", ""}, {"meaning", ""}}};
};

} // namespace

Tolerance read_tolerance(const LocatedPoint& found, const std::string& text, const std::string& option) {
    const Place place{fmt::format("{} {}", option, text), 0, 0};
    const std::size_t equals = text.find('='), colon = text.rfind(':');
    const char* example = "write NAME=SIZE, with a percent sign for a part of the value, and with :uniform behind it "
                          "where it is not a standard deviation";
    if (equals == std::string::npos || equals == 0)
        throw InputError(place, "no tolerance of any parameter", example);
    Tolerance result;
    const std::string name = text.substr(0, equals);
    result.parameter = found.model.independent_parameter(name);
    std::string size = text.substr(equals + 1);
    if (colon != std::string::npos && colon > equals) {
        const std::string word = text.substr(colon + 1);
        if (word != "uniform" && word != "normal")
            throw InputError(place, fmt::format("'{}' is no way in which devices differ", word),
                             "write normal or uniform");
        result.spread = word == "uniform" ? Spread::uniform : Spread::normal;
        size = text.substr(equals + 1, colon - equals - 1);
    }
    const bool share = !size.empty() && size.back() == '%';
    if (share)
        size.pop_back();
    if (size.empty())
        throw InputError(place, "a tolerance without a size", example);
    result.size = value_of(found.model, size, option);
    if (share) {
        const double value = found.point.solution.orbit.parameters[result.parameter.place()];
        if (value == 0)
            throw InputError(place, fmt::format("'{}' is zero, of which there are no percents", name),
                             "give the tolerance in its unit");
        result.size *= 0.01 * std::abs(value);
    }
    if (result.size < 0)
        throw InputError(place, "a tolerance below zero", "give its size");
    if (result.parameter == found.located.control())
        throw InputError(place, fmt::format("'{}' is the parameter whose value follows from the others", name),
                         "vary others, or choose another one by parameter");
    return result;
}

void read_interval(YieldSettings& settings, const LocatedPoint& found, const std::string& text,
                   const std::string& option) {
    const auto number = [&](const std::string& part) { return value_of(found.model, part, option); };
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos || text.size() == 1)
        throw InputError(Place{option, 0, 0}, fmt::format("'{}' is no interval", text),
                         "write LOW:HIGH; one of the two may be left out");
    if (colon > 0)
        settings.least = number(text.substr(0, colon));
    if (colon + 1 < text.size())
        settings.greatest = number(text.substr(colon + 1));
}

Table derivative_table(const LocatedPoint& found, const YieldSettings* settings, const Yield* yield) {
    const LocatedValue& located = found.located;
    std::vector<Table::Column> columns{{"parameter", ""}, {"value", ""}, {"d" + found.name, ""}, {"relative", ""}};
    if (yield)
        for (const char* name : {"deviation", "effect", "share"})
            columns.push_back({name, ""});
    Table table(columns);
    const std::vector<std::string> names = found.model.independent_parameters();
    for (std::size_t i = 0; i < located.others().size(); ++i) {
        const ParameterId parameter = located.others()[i];
        table.add(names[parameter.place()], located.values()[i], located.derivatives()[i],
                  located.value() != 0 ? located.derivatives()[i] * located.values()[i] / located.value()
                                       : not_a_number);
        if (!yield)
            continue;
        const auto& tolerances = settings->tolerances;
        const auto& parts = yield->contributions;
        const auto tolerance = std::find_if(tolerances.begin(), tolerances.end(),
                                            [&](const Tolerance& one) { return one.parameter == parameter; });
        const auto part = std::find_if(parts.begin(), parts.end(),
                                       [&](const Contribution& one) { return one.parameter == parameter; });
        table.add(tolerance == tolerances.end() ? not_a_number : tolerance->deviation(),
                  part == parts.end() ? not_a_number : part->deviation,
                  part == parts.end() ? not_a_number : part->share);
    }
    return table;
}

Table yield_table(const Yield& yield, const std::string& name) {
    StatisticRows result;
    result.add("nominal", yield.nominal, fmt::format("{} without tolerances", name));
    result.add("devices", static_cast<double>(yield.made), "that were made");
    result.add("found", static_cast<double>(yield.found), "with a value; what follows is of them");
    result.add("inadmissible", static_cast<double>(yield.inadmissible), "of which something else happens first");
    result.add("failed", static_cast<double>(yield.failed), "not found by Newton's method");
    result.add("mean", yield.mean, "");
    result.add("deviation", yield.deviation, "standard deviation");
    result.add("linear_deviation", yield.linear_deviation, "the same by the derivatives alone");
    result.add("largest_departure", yield.largest_departure, "of a device from what the derivatives say");
    for (const QuantileEstimate& one : yield.quantiles)
        result.add(fmt::format("quantile_{:g}", one.share), one.value, one.low.value_or(not_a_number),
                   one.high.value_or(not_a_number), "this share lies below");
    result.add("within", yield.within, "share of all devices that is wanted");
    if (yield.linear_within)
        result.add("linear_within", *yield.linear_within, "the same by the derivatives alone");
    return result.table;
}

} // namespace graze
