#include "graze/base/file_name.hpp"
#include "graze/model/model_file.hpp"
#include "graze/symbolic/parser.hpp"
#include "study/record_inputs.hpp"
#include "study/run_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

void read_files(const StudyReader& reader, const TomlEntry& entry, std::size_t direction, RecordRequest& request) {
    if (!entry.node->is_string() && !entry.node->is_array())
        reader.fail(entry, fmt::format("{} must be a name or a list of names", entry.path), "write it as \"run*.csv\"");
    reader.each(reader.items(entry), [&](const TomlEntry& item) {
        for (RecordInput input : record_inputs(reader.file(), reader.toml().string(item), reader.inside(item))) {
            input.direction = direction;
            fingerprint_record(input);
            request.inputs.push_back(std::move(input));
        }
    });
    if (request.inputs.empty())
        reader.fail(entry, fmt::format("{} names no record", entry.path), "name one");
}

/// Reads the key `files`: a name, a list, or { up = ..., down = ... }.
void read_all_files(const StudyReader& reader, const TomlEntry& entry, RecordRequest& request) {
    if (!entry.node->is_table())
        return read_files(reader, entry, 0, request);
    request.directions.clear();
    reader.each_of(entry, {"up", "down"}, [&](const TomlEntry& item) {
        request.directions.push_back(item.name);
        read_files(reader, item, request.directions.size() - 1, request);
    });
    if (request.directions.empty())
        reader.fail(entry, fmt::format("{} names no record", entry.path), "give up = [...] or down = [...]");
}

} // namespace

void read_scales(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    reader.each_of(entry, {}, [&](const TomlEntry& channel) {
        RecordProcessing::Scale scale;
        scale.channel = channel.name;
        if (channel.node->is_table())
            reader.read_keys(channel,
                             {{"factor", reader.into(scale.factor)},
                              {"offset", reader.into(scale.offset)},
                              {"unit", [&](const TomlEntry& item) { scale.unit = reader.toml().line(item); }}});
        else
            scale.factor = reader.number(StudyReader::no_model(), channel);
        run.record().processing.scales.push_back(scale);
    });
}

void read_part(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    std::tie(run.record().processing.begin, run.record().processing.end) = reader.range(StudyReader::no_model(), entry);
}

void read_filter(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    RecordProcessing& processing = run.record().processing;
    const auto positive = [&](double& number) { return reader.into(number, StudyReader::no_model(), positive_number); };
    reader.read_keys(entry, {{"pass", positive(processing.pass)}, {"stop", positive(processing.stop)}});
    if (processing.pass == 0)
        reader.fail(entry, fmt::format("{} does not say what passes", entry.path), "give pass = FREQUENCY");
}

void read_derivative(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    RecordProcessing& processing = run.record().processing;
    if (entry.node->is_string())
        return reader.into(processing.derivative)(entry);
    reader.read_keys(entry, {{"channel", reader.into(processing.derivative)},
                             {"half_width", reader.into(processing.half_width, {RecordProcessing::least_half_width,
                                                                                RecordProcessing::most_half_width})}});
}

namespace {

RecordSampling read_record_sampling(const StudyReader& reader, const TomlEntry& entry) {
    using Kind = RecordSampling::Kind;
    RecordSampling sampling;
    sampling.name = entry.name;
    require_plain_line(sampling.name, "name of a sampling", entry.place);
    bool placed = false;
    const auto place = [&](Kind kind) {
        if (placed)
            reader.fail(entry, fmt::format("{} is taken in two places", entry.path), "make two samplings of it");
        placed = true;
        sampling.kind = kind;
    };
    const auto of_channel = [&](Kind kind) {
        return [&, kind](const TomlEntry& item) {
            place(kind);
            sampling.channel = reader.toml().line(item);
        };
    };
    const auto of_all = [&](Kind kind) {
        return [&, kind](const TomlEntry& item) {
            if (reader.toml().boolean(item))
                place(kind);
        };
    };
    const auto of_phase = [&](const TomlEntry& item) {
        place(Kind::section);
        sampling.phase = reader.number(StudyReader::no_model(), item);
        if (!(sampling.phase >= 0 && sampling.phase < 1))
            reader.fail(item, fmt::format("{} is no part of a period", item.path),
                        "give a number from 0 to less than 1");
    };
    ImpactWindow& impacts = sampling.impacts;
    reader.read_keys(entry,
                     {{"section", of_phase},
                      {"maxima", of_channel(Kind::maxima)},
                      {"minima", of_channel(Kind::minima)},
                      {"record", of_all(Kind::record)},
                      {"peak_to_peak", of_all(Kind::peak_to_peak)},
                      {"amplitude", of_all(Kind::amplitude)},
                      {"impacts", of_channel(Kind::impacts)},
                      {"image", reader.into(sampling.negated)},
                      {"displacement", reader.into(sampling.displacement)},
                      {"window", reader.into(impacts.window, {ImpactWindow::least_window, ImpactWindow::most_window})},
                      {"transition", reader.into(impacts.transition, {0, ImpactWindow::most_window})},
                      {"least_jump", reader.into(impacts.least_jump)}});
    if (!placed)
        reader.fail(entry, fmt::format("{} does not say where", entry.path),
                    "give one of section, maxima, minima, peak_to_peak, amplitude, impacts or record");
    if (!sampling.negated.empty() && sampling.kind != Kind::section)
        reader.fail(entry, fmt::format("{} has an image, which sections have", entry.path), "leave `image` out");
    return sampling;
}

/// Reads the key `channels`, ["V", "I"] or { v = "dq/dt" }; without it values may use all channels.
void read_channels(const StudyReader& reader, const RecordHeader& header, RecordRequest& request, const RunKeys& keys) {
    if (const auto found = keys.find("channels"); found != keys.end()) {
        const TomlEntry& entry = found->second;
        const auto add = [&](const TomlEntry& item, const std::string& name, const std::string& channel) {
            try {
                header.channel(channel, "channels");
            } catch (const InputError& error) {
                reader.fail(item, error.problem(), error.remedy());
            }
            request.channels.push_back({name, channel});
        };
        if (entry.node->is_table())
            reader.each_of(entry, {}, [&](const TomlEntry& item) { add(item, item.name, reader.toml().line(item)); });
        else
            reader.each(reader.items(entry),
                        [&](const TomlEntry& item) { add(item, reader.toml().line(item), reader.toml().line(item)); });
    } else {
        for (const Channel& channel : header.channels)
            request.channels.push_back({channel.name, channel.name});
    }
    for (const RecordRequest::Kept& one : request.channels)
        if (!is_valid_name(one.name))
            throw InputError(keys.contains("channels") ? keys.at("channels").place : keys.at("kind").place,
                             fmt::format("the channel '{}' has no name that expressions can use", one.name),
                             fmt::format("give it one: channels = {{ name = \"{}\" }}", one.channel));
}

void read_reference(const StudyReader& reader, RecordRequest& request, const TomlEntry& entry) {
    if (entry.node->is_string())
        request.reference = reader.toml().line(entry);
    else
        reader.read_keys(entry,
                         {{"channel", reader.into(request.reference)},
                          {"level", reader.into(request.level)},
                          {"hysteresis", reader.into(request.hysteresis, StudyReader::no_model(), positive_number)}});
    if (std::ranges::find(request.channels, request.reference, &RecordRequest::Kept::name) == request.channels.end())
        reader.fail(entry, fmt::format("there is no channel '{}'", request.reference),
                    "name one of those that the run keeps");
}

/// The header of the first record after it has been processed.
RecordHeader header_of(const StudyReader& reader, const StudyRun& run, const RunKeys& keys) {
    const RecordRequest& request = run.record();
    try {
        std::unique_ptr<SampleSource> source;
        if (request.bench) {
            RecordHeader header{{"t", "s"}, {}};
            Samples two{{0, 1}, {}};
            for (const BenchChannel& channel : request.bench->channels) {
                header.channels.push_back({channel.value.name, channel.value.unit});
                two.values.push_back({0, 0});
            }
            source = std::make_unique<StoredSamples>(header, two);
        } else {
            source = open_record(request.inputs.front().path, request.processing.layout);
        }
        return ProcessedRecord(std::move(source), request.processing).header();
    } catch (const InputError& error) {
        if (!error.place().file.empty() && error.place().line > 0)
            throw;
        reader.fail(keys.at(request.bench ? "bench" : "files"),
                    (request.bench ? "" : fmt::format("'{}': ", request.inputs.front().name)) + error.problem(),
                    error.remedy());
    }
}

void check_samplings(const StudyReader& reader, const StudyRun& run, const TomlEntry& entry) {
    const RecordRequest& request = run.record();
    std::vector<std::string> known = run.value_names;
    for (const RecordRequest::Kept& one : request.channels)
        known.push_back(one.name);
    const auto require = [&](const std::string& name) {
        if (std::find(known.begin(), known.end(), name) == known.end())
            reader.fail(entry, fmt::format("there is no channel or value '{}'", name), study_name_remedy(name, known));
    };
    for (const RecordSampling& sampling : request.samplings) {
        if (sampling.is_periodic() && request.reference.empty())
            reader.fail(entry, fmt::format("nothing says what begins the periods of '{}'", sampling.name),
                        "name the channel of the input: reference = \"V\"");
        for (const std::string* name : {&sampling.channel, &sampling.displacement})
            if (!name->empty())
                require(*name);
        for (const std::string& name : sampling.negated)
            if (std::find(run.value_names.begin(), run.value_names.end(), name) == run.value_names.end())
                reader.fail(entry, fmt::format("there is no value '{}' to change its sign", name),
                            study_name_remedy(name, run.value_names));
    }
    std::vector<std::string> names = request.sampling_names();
    std::sort(names.begin(), names.end());
    if (const auto twice = std::adjacent_find(names.begin(), names.end()); twice != names.end())
        reader.fail(entry, fmt::format("there are two samplings '{}'", *twice), "give one another name");
}

} // namespace

std::vector<std::string> RecordRequest::sampling_names() const {
    std::vector<std::string> names;
    for (const RecordSampling& sampling : samplings) {
        names.push_back(sampling.name);
        if (sampling.kind == RecordSampling::Kind::impacts)
            names.push_back(sampling.name + "_after");
    }
    return names;
}

namespace {

/// The description of a channel: the text of what it measures in the model of a virtual bench; empty for files.
std::string words_of_channel(const RecordRequest& request, const std::string& channel) {
    if (request.bench)
        for (const BenchChannel& one : request.bench->channels)
            if (one.value.name == channel)
                return one.value.text;
    return "";
}

} // namespace

void read_inputs(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, const RunKeys& keys) {
    RecordRequest& request = run.record();
    if (keys.contains("files") == keys.contains("bench"))
        reader.fail(entry, fmt::format("{} has {} records", entry.path, keys.contains("files") ? "two kinds of" : "no"),
                    "give files = \"NAME.csv\", or a virtual bench: bench = { ... }");
    Mistakes mistakes;
    with_key(mistakes, keys, "files", [&](const TomlEntry& files) { read_all_files(reader, files, request); });
    if (keys.contains("bench"))
        mistakes.attempt([&] {
            request.bench.emplace();
            request.bench->model = run.model;
            read_bench(reader, run, keys.at("bench"));
            set_levels(reader, run, keys.at("bench"));
        });
    mistakes.throw_noted();
}

void read_record(const StudyReader& reader, StudyRun& run, const RunKeys& keys) {
    RecordRequest& request = run.record();
    Mistakes mistakes;
    const RecordHeader header = header_of(reader, run, keys);
    read_channels(reader, header, request, keys);
    std::vector<RecordedName> states, coordinates;
    for (const RecordRequest::Kept& one : request.channels)
        states.push_back({one.name, header.channels[header.channel(one.channel, "channels")].unit,
                          words_of_channel(request, one.channel)});
    with_key(mistakes, keys, "reference", [&](const TomlEntry& at) { read_reference(reader, request, at); });
    with_key(mistakes, keys, "coordinate", [&](const TomlEntry& name) {
        if (!is_valid_name(request.coordinate) || request.reference.empty())
            reader.fail(name,
                        fmt::format("'{}' cannot be what the amplitude of the reference is called", request.coordinate),
                        request.reference.empty() ? "name the channel of the input: reference = \"V\""
                                                  : "use letters, digits and '_'");
    });
    mistakes.throw_noted();
    if (!request.reference.empty()) {
        if (request.coordinate.empty())
            request.coordinate = "amplitude";
        const auto of = std::ranges::find(states, request.reference, &RecordedName::name);
        if (std::ranges::find(states, request.coordinate, &RecordedName::name) != states.end())
            reader.fail(
                keys.at("reference"),
                fmt::format("'{}' is a channel, and so cannot be the amplitude of the reference", request.coordinate),
                "give it another name: coordinate = \"NAME\"");
        coordinates.push_back({request.coordinate, of->unit, "amplitude of " + request.reference});
    }
    run.model = model_of_record(states, coordinates, header.time.unit);
    if (keys.contains("sample"))
        mistakes.attempt([&] {
            reader.each_of(keys.at("sample"), {}, [&](const TomlEntry& item) {
                request.samplings.push_back(read_record_sampling(reader, item));
            });
        });
    mistakes.throw_noted();
    if (request.samplings.empty()) {
        const auto add = [&](const char* name, RecordSampling::Kind kind) {
            RecordSampling& sampling = request.samplings.emplace_back();
            sampling.name = name;
            sampling.kind = kind;
        };
        add("record", RecordSampling::Kind::record);
        if (!request.reference.empty())
            add("section", RecordSampling::Kind::section);
    }
}

void complete_record(const StudyReader& reader, StudyRun& run, const RunKeys& keys) {
    if (run.values.empty())
        for (const RecordRequest::Kept& one : run.record().channels) {
            run.value_names.push_back(one.name);
            run.value_units.push_back(run.model.states[*run.model.find_state(one.name)].unit);
            run.values.push_back(run.model.symbol(one.name));
        }
    check_samplings(reader, run, keys.contains("sample") ? keys.at("sample") : keys.at("kind"));
}

} // namespace graze
