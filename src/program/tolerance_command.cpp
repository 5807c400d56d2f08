#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "graze/branch/yield.hpp"
#include "graze/picture/figure_script.hpp"
#include "graze/picture/yield_picture.hpp"
#include "graze/results/located_point.hpp"
#include "program/commands.hpp"
#include "program/drawing.hpp"
#include "program/interrupt.hpp"
#include "program/output_file.hpp"
#include "program/status_line.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace graze {

namespace {

/// The point, and the yield if tolerances were given.
struct Findings : LocatedPoint {
    YieldSettings settings{};
    std::optional<Yield> yield{};
};

/// Reads NAME=SIZE, NAME=SIZE% or NAME=SIZE:uniform.
Tolerance tolerance_of(const Findings& found, const std::string& text) {
    const Place place{fmt::format("--vary {}", text), 0, 0};
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
    result.size = value_of(found.model, size, "--vary");
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
                         "vary others, or choose another one by --parameter");
    return result;
}

void set_interval(Findings& found, const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos || text.size() == 1)
        throw InputError(Place{"--within", 0, 0}, fmt::format("'{}' is no interval", text),
                         "write LOW:HIGH; one of the two may be left out");
    if (colon > 0)
        found.settings.least = value_of(found.model, text.substr(0, colon), "--within");
    if (colon + 1 < text.size())
        found.settings.greatest = value_of(found.model, text.substr(colon + 1), "--within");
}

void set_yield(Findings& found, const System& system, const ToleranceArguments& arguments, const Console& console) {
    YieldSettings& settings = found.settings;
    for (const std::string& item : split_list(arguments.vary))
        settings.tolerances.push_back(tolerance_of(found, item));
    if (!arguments.within.empty())
        set_interval(found, arguments.within);
    settings.devices = arguments.devices;
    settings.seed = arguments.seed;
    settings.jobs = threads_for(arguments.jobs);
    settings.interrupted = [] { return InterruptGuard::requested(); };
    StatusLine line(console, console.terminal);
    settings.progress = [&](std::size_t devices) {
        if (line.is_due())
            line.show(fmt::format("device {} of {}", devices, arguments.devices));
    };
    found.yield =
        with_place({"--vary", 0, 0}, [&] { return yield_of(system, found.point, found.located.control(), settings); });
}

/// Derivatives by all parameters, and the contributions of those with tolerances.
Table derivatives_of(const Findings& found) {
    const LocatedValue& located = found.located;
    std::vector<Table::Column> columns{{"parameter", ""}, {"value", ""}, {"d" + found.name, ""}, {"relative", ""}};
    if (found.yield)
        for (const char* name : {"deviation", "effect", "share"})
            columns.push_back({name, ""});
    Table table(columns);
    const std::vector<std::string> names = found.model.independent_parameters();
    for (std::size_t i = 0; i < located.others().size(); ++i) {
        const ParameterId parameter = located.others()[i];
        table.add(names[parameter.place()], located.values()[i], located.derivatives()[i],
                  located.value() != 0 ? located.derivatives()[i] * located.values()[i] / located.value()
                                       : not_a_number);
        if (!found.yield)
            continue;
        const auto& tolerances = found.settings.tolerances;
        const auto& parts = found.yield->contributions;
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

/// Statistics as rows of a table and as members of a JSON object.
class Statistics {
public:
    Statistics() : table_({{"quantity", ""}, {"value", ""}, {"low", ""}, {"high", ""}, {"meaning", ""}}) {}
    void add(const std::string& name, double value, double low, double high, const std::string& meaning) {
        table_.add(name, value, low, high, meaning);
        values_.add(name, value);
        if (std::isfinite(low) || std::isfinite(high)) {
            values_.add(name + "_low", low);
            values_.add(name + "_high", high);
        }
    }
    void add(const std::string& name, double value, const std::string& meaning) {
        add(name, value, not_a_number, not_a_number, meaning);
    }
    void add(const std::string& name, const std::optional<ConfidenceInterval>& one, const std::string& meaning) {
        if (one)
            add(name, one->value, one->low, one->high, meaning);
    }
    const Table& table() const { return table_; }
    const JsonObject& values() const { return values_; }

private:
    Table table_;
    JsonObject values_;
};

Statistics statistics_of(const Findings& found) {
    const Yield& yield = *found.yield;
    Statistics result;
    result.add("nominal", yield.nominal, fmt::format("{} without tolerances", found.name));
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
    return result;
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
    heading.add("statistics", statistics_of(found).values());
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
        deliver(derivatives_of(found), here, tolerance_heading(file, found), inner);
    if (output.format == TableFormat::table && found.yield)
        text << '\n';
    if (output.format != TableFormat::json && found.yield)
        deliver(statistics_of(found).table(), here, {}, inner);
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

} // namespace

int tolerance_command(const ToleranceArguments& arguments, const Console& console) {
    require_devices(arguments);
    const ResultFile file(result_path(arguments.file), ResultFile::Access::read);
    Findings found{located_point(file, arguments.point, arguments.parameter, {"POINT", 0, 0}, {"--parameter", 0, 0})};
    const System system(found.stored.run.model);
    const InterruptGuard guard;
    if (!arguments.vary.empty())
        set_yield(found, system, arguments, console);
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

} // namespace graze
