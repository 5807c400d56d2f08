#include "program/loss_point.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/rounded.hpp"
#include "graze/branch/curve_start.hpp"
#include "program/quantity.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t most_numbers = 1000;

/// A point of another kind may be on a curve of folds. Touches come first.
bool is_fold(const SpecialPoint& point) {
    if (point.type == PointType::fold)
        return true;
    const std::vector<PointType> known = curves_at(point);
    const auto has = [&](PointType type) { return std::find(known.begin(), known.end(), type) != known.end(); };
    return point.type != PointType::branch_point && has(PointType::fold) && !has(PointType::grazing);
}

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& what,
                         const char* example) {
    throw InputError(Place{option + " " + text, 0, 0}, what, example);
}

/// A value for each decade from the first to the last.
void add_decades(std::vector<double>& values, double first, double last, const std::string& option,
                 const std::string& text) {
    if (!(first * last > 0))
        refuse(option, text, "the ends of the range are not of one sign", "write 1e-3,1e-6 or 1e-2:1e-20");
    const double decades = std::abs(std::log10(first / last));
    if (!(decades < most_numbers))
        refuse(option, text, "the range is too long", "write 1e-3,1e-6 or 1e-2:1e-20");
    const auto count = static_cast<int>(std::floor(decades + 1e-9));
    constexpr int decimals = 15; // so that powers of ten are what people write
    for (int i = 0; i <= count; ++i) {
        const long double decade = std::pow(10.0L, std::abs(first) > std::abs(last) ? -i : i);
        values.push_back(rounded(static_cast<double>(first * decade), decimals));
    }
}

LossPoint of_fold(StoredOrbit stored, const std::string& asked) {
    System system(stored.run.model);
    const std::vector<ParameterId> candidates = moving_parameters(stored.run, asked);
    if (candidates.empty())
        throw InputError("nothing is said to move the orbit from its fold", "name a parameter by --parameter NAME");
    std::optional<FoldPassage> fold;
    for (const ParameterId one : candidates)
        try {
            fold = fold_passage(system, stored.record.point, one);
            break;
        } catch (const InputError&) {
            if (one == candidates.back())
                throw;
        }
    if (!fold->attracting)
        throw InputError("neither of the two orbits that meet there is stable: no motion is lost",
                         "choose a fold at which a stable branch ends");
    LossPoint point{
        .stored = std::move(stored), .system = system, .parameter = fold->parameter, .name = {}, .unit = {}};
    point.value = fold->value;
    point.side = fold->side;
    point.cycle = fold->cycle;
    point.fold = std::move(fold);
    return point;
}

LossPoint of_touch(StoredOrbit stored, const std::string& asked) {
    TouchingOrbit found = touching_orbit(std::move(stored), asked);
    Verdict verdict = verdict_of(found.map);
    const double level = level_of_map(found.map, verdict);
    if (!found.parameter || !found.map.clearance_rate || *found.map.clearance_rate == 0)
        throw InputError(Place{}, "nothing is said to move the orbit from its touch",
                         "name a parameter by --parameter NAME");
    System system(found.stored.run.model);
    LossPoint point{.stored = std::move(found.stored),
                    .system = std::move(system),
                    .parameter = *found.parameter,
                    .name = {},
                    .unit = {}};
    point.value = found.map.contact.touch.parameters[found.parameter->place()];
    point.side = *found.map.clearance_rate < 0 ? 1 : -1;
    point.cycle = found.map.time;
    point.level = level;
    point.map = std::move(found.map);
    point.verdict = std::move(verdict);
    return point;
}

} // namespace

LossPoint loss_point(const ResultFile& file, const std::string& point, const std::string& parameter,
                     const std::string& option) {
    StoredOrbit stored = find_stored_orbit(file, point, {option, 0, 0});
    try {
        LossPoint found = is_fold(stored.record.point) ? of_fold(std::move(stored), parameter)
                                                       : of_touch(std::move(stored), parameter);
        found.name = found.model().independent_parameters()[found.parameter.place()];
        found.unit = found.model().parameters[*found.model().find_parameter(found.name)].unit;
        return found;
    } catch (const InputError& error) {
        if (!error.place().file.empty() && error.place().file != "POINT")
            throw;
        throw InputError(Place{option, 0, 0}, error.problem(), error.remedy());
    }
}

AskedEnd end_of(const LossPoint& point, const TripArguments& arguments) {
    if (arguments.greatest_speed && point.fold)
        throw InputError(Place{"--greatest-speed", 0, 0}, "a fold has no contact of its own",
                         "name a level, --until EXPR=LEVEL, or --until end");
    if (arguments.greatest_speed)
        return {{*arguments.greatest_speed, {}, 0}, fmt::format("speed {:.4g}", *arguments.greatest_speed), true};
    if (arguments.until == "end")
        return {{}, "the end", true};
    if (arguments.until.empty() && point.fold)
        return {{}, "the fold is passed", false};
    if (arguments.until.empty())
        return {{point.level, {}, 0}, fmt::format("speed {:.4g}", point.level), false};
    const std::size_t equals = arguments.until.rfind('=');
    if (equals == std::string::npos)
        throw InputError(Place{"--until " + arguments.until, 0, 0}, "it names no level",
                         "write EXPR=LEVEL, such as q=0.9, or end");
    AskedEnd asked{{}, arguments.until, true};
    asked.end.quantity = requested_quantity(point.model(), arguments.until.substr(0, equals), "--until").value;
    asked.end.level = value_of(point.model(), arguments.until.substr(equals + 1), "--until");
    return asked;
}

std::vector<double> numbers_by_decades(const Model& model, const std::vector<std::string>& asked,
                                       const std::string& option) {
    std::vector<double> values;
    for (const std::string& text : split_list(asked)) {
        const std::size_t colon = text.find(':');
        const auto number = [&](const std::string& part) { return value_of(model, part, option); };
        if (colon == std::string::npos)
            values.push_back(number(text));
        else
            add_decades(values, number(text.substr(0, colon)), number(text.substr(colon + 1)), option, text);
    }
    if (values.size() > most_numbers)
        refuse(option, "", fmt::format("{} numbers are too many", values.size()), "write 1e-3,1e-6 or 1e-2:1e-20");
    return values;
}

std::string why_not(const TripTime& trip, const std::string& longer) {
    if (!trip.detail.empty())
        return trip.detail;
    if (trip.ending == "end-time")
        return fmt::format("it has been simulated for {:.6g} cycles; {}", trip.cycles, longer);
    return fmt::format("it ended by {}", trip.ending);
}

void tell_lacks(const std::vector<std::string>& lacks, const Console& console) {
    constexpr std::size_t most = 5;
    for (std::size_t i = 0; i < std::min(most, lacks.size()); ++i)
        console.err << fmt::format("graze: {}\n", lacks[i]);
    if (lacks.size() > most)
        console.err << fmt::format("graze: {} more are like that\n", lacks.size() - most);
}

JsonObject heading_of(const ResultFile& file, const LossPoint& point, const AskedEnd& end) {
    const OrbitRecord& record = point.stored.record;
    JsonObject heading;
    heading.add("graze", GRAZE_VERSION);
    heading.add("file", file.path());
    heading.add("model", point.model().name);
    heading.add("run", point.stored.run.record.name);
    heading.add("number", static_cast<double>(record.number));
    heading.add("label", record.label);
    heading.add("parameter", point.name);
    heading.add(point.kind(), point.value);
    heading.add("cycle", point.cycle);
    if (point.fold) {
        heading.add("coefficient", point.fold->coefficient);
        heading.add("rate", point.fold->rate);
    } else {
        heading.add("speed", end.end.speed > 0 ? std::min(point.level, end.end.speed) : point.level);
    }
    heading.add("end", end.words);
    return heading;
}

} // namespace graze
