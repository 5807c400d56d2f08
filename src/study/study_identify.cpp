#include "graze/symbolic/parser.hpp"
#include "study/estimate_kind.hpp"
#include "study/identify_run.hpp"
#include "study/run_description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace graze {

namespace {

void require_parameter(const StudyReader& reader, const Model& model, const TomlEntry& entry, const std::string& name) {
    if (!model.find_independent_parameter(name))
        reader.fail(entry, fmt::format("model '{}' has no parameter '{}'", model.name, name),
                    study_name_remedy(name, model.independent_parameters()));
}

} // namespace

void read_records(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    run.identify().records = reader.strings(entry);
    run.identify().records_place = entry.place;
}

void read_gives(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        const std::string parameter = reader.toml().string(item);
        require_parameter(reader, run.model, item, parameter);
        const std::vector<std::string>& known = estimate_kind(run.identify().what).numbers;
        // From several records there are numbers of each record, under names with the record.
        const bool of_record =
            item.name.find(" of ") != std::string::npos || item.name.find("spread_between") != std::string::npos;
        if (!of_record && run.identify().what != IdentifyRequest::What::fit &&
            std::find(known.begin(), known.end(), item.name) == known.end())
            throw InputError(item.place, fmt::format("nothing of the name '{}' is found", item.name),
                             fmt::format("it finds {}", fmt::join(known, ", ")));
        for (const auto& [name, other] : run.identify().gives)
            if (other == parameter)
                reader.fail(item, fmt::format("'{}' and '{}' cannot both be '{}'", name, item.name, parameter),
                            "leave one of them out");
        run.identify().gives.emplace_back(item.name, parameter);
    });
}

/// Reads unknowns: names, or { NAME = GUESS }, or { NAME = { guess, bounds } }.
void read_unknowns(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    const auto add = [&](const TomlEntry& item, const std::string& name) -> IdentifyRequest::Unknown& {
        require_parameter(reader, run.model, item, name);
        return run.identify().unknowns.emplace_back(IdentifyRequest::Unknown{name, "", "", "", item.place});
    };
    if (!entry.node->is_table())
        return reader.each(reader.items(entry), [&](const TomlEntry& item) { add(item, reader.toml().string(item)); });
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        IdentifyRequest::Unknown& unknown = add(item, item.name);
        if (!item.node->is_table()) {
            unknown.guess = reader.number_text(run.model, item);
            return;
        }
        reader.each_of(item, {"guess", "bounds"}, [&](const TomlEntry& part) {
            if (part.name == "guess") {
                unknown.guess = reader.number_text(run.model, part);
                return;
            }
            const auto [least, greatest] = reader.range(run.model, part);
            unknown.least = fmt::format("{:.17g}", least);
            unknown.greatest = fmt::format("{:.17g}", greatest);
        });
    });
}

/// Reads readings: channels, or { CHANNEL = "EXPRESSION" }, or { CHANNEL = { value, gain, offset, noise } }.
void read_readings(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    const auto add = [&](const TomlEntry& item, const std::string& channel, const std::string& value) {
        named_value(run.model, value, reader.inside(item));
        IdentifyRequest::Reading& reading = run.identify().readings.emplace_back();
        reading.channel = channel;
        reading.value = value;
        reading.place = reader.inside(item);
    };
    if (!entry.node->is_table())
        return reader.each(reader.items(entry), [&](const TomlEntry& item) {
            add(item, reader.toml().line(item), reader.toml().line(item));
        });
    const auto number_or_unknown = [&](double& number, bool& unknown) {
        return [&](const TomlEntry& part) {
            part.node->is_boolean() ? reader.into(unknown)(part) : reader.into(number)(part);
        };
    };
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        if (item.node->is_string())
            return add(item, item.name, reader.toml().line(item));
        IdentifyRequest::Reading reading;
        reading.channel = reading.value = item.name;
        reading.place = item.place;
        reader.read_keys(item, {{"value", reader.into(reading.value)},
                                {"gain", number_or_unknown(reading.gain, reading.gain_unknown)},
                                {"offset", number_or_unknown(reading.offset, reading.offset_unknown)},
                                {"noise", reader.into(reading.noise, StudyReader::no_model(), positive_number)}});
        named_value(run.model, reading.value, item.place);
        run.identify().readings.push_back(reading);
    });
}

void read_known(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    if (entry.node->is_boolean()) {
        run.identify().all_known = reader.toml().boolean(entry);
        return;
    }
    run.identify().known = reader.strings(entry);
    for (const std::string& name : run.identify().known)
        if (!run.model.find_state(name))
            reader.fail(entry, fmt::format("model '{}' has no state '{}'", run.model.name, name),
                        study_name_remedy(name, names_of(run.model.states)));
}

namespace {

void require_what_is_needed(const StudyReader& reader, const StudyRun& run, const TomlEntry& entry) {
    const IdentifyRequest& request = run.identify();
    if (request.records.empty())
        reader.fail(entry, fmt::format("{} has no records", entry.path),
                    "name runs of kind \"record\": records = \"NAME\"");
    if (request.what == IdentifyRequest::What::coupling && (request.gap.empty() || request.stiffness.empty()))
        reader.fail(entry, fmt::format("{}: gap or stiffness are not known", entry.path),
                    "give gap and stiffness, such as gap = \"d\" and stiffness = \"m*w0^2\"");
    if (request.beta1.empty() != request.beta2.empty() || (!request.beta1.empty() && request.gap.empty()))
        reader.fail(entry, fmt::format("{}: a leakage inductance needs beta1, beta2 and the gap", entry.path),
                    "give all of them, or none");
    if (request.what == IdentifyRequest::What::fit && (request.unknowns.empty() || request.readings.empty()))
        reader.fail(entry, fmt::format("{} does not say what is to be found, or what was read", entry.path),
                    "give unknowns = [\"PARAMETER\"] and readings = [\"CHANNEL\"]");
}

} // namespace

void read_estimate(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, const RunKeys& keys) {
    const std::vector<std::string>& kinds = kinds_of_estimates();
    if (!keys.contains("what"))
        reader.fail(entry, fmt::format("{} does not say what is to be found", entry.path),
                    fmt::format("give what = \"{}\" or \"{}\"", fmt::join(kinds.begin(), kinds.end() - 1, "\", \""),
                                kinds.back()));
    run.identify().what = static_cast<IdentifyRequest::What>(reader.choice(keys.at("what"), kinds));
}

void complete_identify(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    require_what_is_needed(reader, run, entry);
    run.value_names = residual_names(run.identify());
    run.value_units.assign(run.value_names.size(), "");
}

} // namespace graze
