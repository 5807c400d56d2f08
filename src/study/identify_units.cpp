#include "study/identify_units.hpp"

#include "graze/base/physical_unit.hpp"
#include "study/estimate_kind.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <optional>

namespace graze {

namespace {

/// Units of the model's time, parameters and states that have the dimension of this unit.
std::vector<std::string> units_alike(const Model& model, const PhysicalUnit& unit) {
    std::vector<std::string> found;
    const auto add = [&](const std::string& text) {
        const auto one = told_unit(text);
        if (one && one->dimension == unit.dimension && std::find(found.begin(), found.end(), text) == found.end())
            found.push_back(text);
    };
    add(model.time_unit);
    for (const Parameter& one : model.parameters)
        add(one.unit);
    for (const State& one : model.states)
        add(one.unit);
    return found;
}

/// The unit of a parameter. One without a unit is a pure number where other parameters have units; where none has,
/// nothing is known.
std::optional<PhysicalUnit> unit_in_model(const Model& model, const std::string& text) {
    if (!text.empty())
        return told_unit(text);
    const bool has_units =
        !model.time_unit.empty() || std::any_of(model.parameters.begin(), model.parameters.end(),
                                                [](const Parameter& one) { return !one.unit.empty(); });
    return has_units ? std::optional(PhysicalUnit()) : std::nullopt;
}

/// @param wanted units, any of which is right; none: every unit is
bool agrees(const PhysicalUnit& unit, const std::vector<std::string>& wanted) {
    return wanted.empty() ||
           std::any_of(wanted.begin(), wanted.end(), [&](const std::string& text) { return told_unit(text) == unit; });
}

void check_channel(const StudyRun& run, const Channel& channel) {
    const auto unit = told_unit(channel.unit);
    if (!unit)
        return;
    const std::vector<std::string> wanted = units_alike(run.model, *unit);
    if (agrees(*unit, wanted))
        return;
    throw InputError(fmt::format("channel '{}' is in {}, and what the model has of that kind in {}", channel.name,
                                 channel.unit, fmt::join(wanted, " and ")),
                     scale_remedy(channel, wanted.front()));
}

/// Checks the unit of a number that is known beforehand. Only a text that is the name of a parameter has a known unit.
void check_known(const StudyRun& run, const char* key, const std::string& text, const std::string& kind) {
    const auto parameter = run.model.find_parameter(text);
    const auto wanted = told_unit(kind);
    if (!parameter || !wanted)
        return;
    const std::string& unit = run.model.parameters[*parameter].unit;
    const auto one = unit_in_model(run.model, unit);
    if (one && one->dimension != wanted->dimension)
        throw InputError(run.place,
                         fmt::format("{} = \"{}\" is {}, and {} is wanted", key, text,
                                     unit.empty() ? "a number without a unit" : "in " + unit, kind),
                         "name another parameter, or write what is meant in parameters");
}

/// @param length unit of displacements
void check_known_numbers(const StudyRun& run, const std::string& length) {
    const IdentifyRequest& request = run.identify();
    check_known(run, "gap", request.gap, length);
    check_known(run, "clamped", request.clamped, length);
    check_known(run, "beta2", request.beta2, length);
    check_known(run, "frequency", request.frequency, "Hz");
    if (length == "m") {
        check_known(run, "stiffness", request.stiffness, "N/m");
        check_known(run, "beta1", request.beta1, "H m");
    }
}

/// Whether a number has no unit by its nature. Names of several records begin with that of one record.
bool is_ratio(const std::string& name) {
    return std::any_of(estimate_kinds().begin(), estimate_kinds().end(), [&](const EstimateKind& kind) {
        return std::any_of(kind.ratios.begin(), kind.ratios.end(),
                           [&](const std::string& ratio) { return name.starts_with(ratio); });
    });
}

/// The factor between two units. Hz and rad/s differ by 2 pi.
double factor_between(const std::string& from, const std::string& to) {
    const auto is = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    const double factor = converted(1, *told_unit(from), *told_unit(to));
    if (is(from, "Hz") && is(to, "rad"))
        return factor * 2 * std::numbers::pi;
    return is(from, "rad") && is(to, "Hz") ? factor / (2 * std::numbers::pi) : factor;
}

} // namespace

std::string scale_remedy(const Channel& channel, const std::string& unit) {
    const auto from = told_unit(channel.unit), to = told_unit(unit);
    const std::string factor =
        from && to && from->dimension == to->dimension ? fmt::format("{:g}", converted(1, *from, *to)) : "FACTOR";
    return fmt::format("convert it in the run that has the record: scale = {{ {} = {{ factor = {}, unit = \"{}\" }} }}",
                       channel.name, factor, unit);
}

void check_record_time(const StudyRun& run, const RecordHeader& header) {
    const std::string &read = header.time.unit, &meant = run.model.time_unit;
    const auto unit = told_unit(read), wanted = told_unit(meant);
    if (read.empty() || meant.empty() || unit_symbol(read) == unit_symbol(meant) || (unit && unit == wanted))
        return;
    if (!unit && wanted)
        throw InputError(
            fmt::format("the unit of its time, '{}', is not known, and that of the model is {}", read, meant),
            "give times in s, ms, us, ns, min or h");
    throw InputError(fmt::format("its time is in {}, and that of the model in {}", read, meant),
                     "convert the times of the record");
}

void check_record_units(const StudyRun& run, const RecordHeader& header) {
    const IdentifyRequest& request = run.identify();
    const auto channel = [&](const std::string& name, const char* key) -> const Channel& {
        return header.channels[header.channel(name, key)];
    };
    std::string length = "m"; // unless the record has another unit of displacements
    if (request.what == IdentifyRequest::What::coupling) {
        const Channel& q = channel(request.displacement.empty() ? "q" : request.displacement, "displacement");
        check_channel(run, q);
        if (told_unit(q.unit))
            length = q.unit;
    }
    if (request.what == IdentifyRequest::What::impedance && (!request.frequency.empty() || !request.beta1.empty()))
        check_record_time(run, header);
    if (request.what == IdentifyRequest::What::impedance && !request.beta1.empty()) {
        check_channel(run, channel(request.voltage, "voltage"));
        check_channel(run, channel(request.current, "current"));
    }
    check_known_numbers(run, length);
}

void convert_to_model(EstimateRecords& estimates, const StudyRun& run) {
    const std::size_t count = estimates.numbers.size();
    for (std::size_t i = 0; i < count; ++i) {
        EstimateRecord& number = estimates.numbers[i];
        const auto parameter = run.model.find_independent_parameter(number.name);
        if (!parameter)
            continue;
        const std::string unit = run.model.parameter_unit(number.name);
        const auto* const request = std::get_if<IdentifyRequest>(&run.request);
        const bool ratio = request && std::any_of(request->gives.begin(), request->gives.end(), [&](const auto& one) {
                               return one.second == number.name && is_ratio(one.first);
                           });
        const auto from = ratio ? PhysicalUnit() : told_unit(number.unit), to = unit_in_model(run.model, unit);
        if (!from && to && !number.unit.empty() && number.unit != unit_symbol(unit))
            throw InputError(run.place,
                             fmt::format("what is found for '{}' is in '{}', a unit that is not known, and the "
                                         "parameter {}",
                                         number.name, number.unit, unit.empty() ? "a number" : "in " + unit),
                             "give the record units of the SI: a channel by `scale`, times as s, ms, us, ns, min or h");
        if (!from || !to)
            continue;
        const auto in = [](const std::string& text) { return text.empty() ? "without a unit" : "in " + text; };
        if (from->dimension != to->dimension)
            throw InputError(run.place,
                             fmt::format("what is found for '{}' is {}, and the parameter {}", number.name,
                                         in(number.unit), in(unit)),
                             "name another parameter in `gives`, or correct the units of the record by `scale`");
        if (number.unit.empty() || unit.empty())
            continue;
        const double factor = factor_between(number.unit, unit);
        number.unit = unit;
        number.estimate.value *= factor;
        number.estimate.error *= factor;
        for (std::size_t j = 0; j < count && !estimates.covariance.empty(); ++j) {
            estimates.covariance[i * count + j] *= factor; // the diagonal twice
            estimates.covariance[j * count + i] *= factor;
        }
    }
}

} // namespace graze
