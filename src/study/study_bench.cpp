#include "study/run_forms.hpp"

#include "base/concatenated.hpp"
#include "graze/flow/system.hpp"
#include "graze/symbolic/function.hpp"
#include "study/key_reader.hpp"
#include "study/measured_description.hpp"
#include "study/point_limits.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace {

/// Refuses channels that have no finite value at the first sample, which would fail later when the run is carried out.
void require_finite_at_start(const StudyReader& reader, const RecordBench& bench, const TomlEntry& entry) {
    std::vector<Expression> values;
    for (const BenchChannel& channel : bench.channels)
        values.push_back(channel.value.value);
    const std::vector<double> inputs = concatenated(bench.model.initial_state(), bench.model.parameter_values());
    const std::vector<double> found = System(bench.model).function_of(values)(inputs);
    std::size_t next = 0;
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        if (!std::isfinite(found[next++]))
            throw InputError(item.place, fmt::format("{} has no finite value where the motion begins", item.path),
                             "measure something else, or begin elsewhere: from = { ... } or settle = SECONDS");
    });
}

} // namespace

void read_bench_channels(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    RecordBench& bench = *run.record().bench;
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        BenchChannel channel;
        std::optional<std::string> unit;
        const auto value = [&](const TomlEntry& text) {
            channel.value = named_value(bench.model, reader.toml().string(text), reader.inside(text));
        };
        if (item.node->is_string())
            value(item);
        else
            reader.read_keys(item, {{"value", value},
                                    {"unit", [&](const TomlEntry& part) { unit = reader.toml().line(part); }},
                                    {"noise",
                                     [&](const TomlEntry& part) {
                                         channel.noise = reader.number(bench.model, part);
                                         if (!(channel.noise >= 0))
                                             reader.fail(part, fmt::format("{} is {}", part.path, channel.noise),
                                                         "give 0 or more");
                                     }},
                                    {"offset", reader.into(channel.offset, bench.model)},
                                    {"drift", reader.into(channel.drift, bench.model)},
                                    {"range", reader.into(channel.range, bench.model, positive_number)}});
        if (channel.value.name.empty())
            value(item); // throws: it is no expression
        channel.value.name = item.name;
        if (unit)
            channel.value.unit = *unit;
        bench.channels.push_back(std::move(channel));
    });
}

void read_bench(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    RecordBench& bench = *run.record().bench;
    KeyReader::read_table(reader, run, entry, [&bench](auto& keys) { describe_bench(keys, bench); });
    if (!bench.channels.empty() && bench.settle == 0 && run.record().vary.axes.empty())
        reader.each_of(entry, {}, [&](const TomlEntry& item) {
            if (item.name == "channels")
                require_finite_at_start(reader, bench, item);
        });
    if (bench.channels.empty())
        reader.fail(entry, fmt::format("{} measures nothing", entry.path), "give channels = { q = \"q\" }");
    if (!(bench.rate > 0) || !(bench.time > 0) || !(bench.rate * bench.time >= 2) || !(bench.settle >= 0) ||
        !(bench.rate * bench.time <= most_bench_samples))
        reader.fail(entry, fmt::format("{} does not say how many samples there are, from 2 to 10 million", entry.path),
                    "give rate = SAMPLES_IN_A_SECOND, time = SECONDS, and settle, if any, of 0 or more");
}

void set_levels(const StudyReader& reader, StudyRun& run, const TomlEntry& place) {
    RecordBench& bench = *run.record().bench;
    VariedValues& vary = run.record().vary;
    const std::vector<std::string> names = bench.model.independent_parameters();
    if (vary.axes.size() > 1 || (!vary.axes.empty() && (vary.axes.front().state || vary.axes.front().values.empty())))
        reader.fail(place, "a bench goes through the values of one parameter",
                    "give vary = { V0 = { from = 1, to = 2, step = 0.1 } }, or leave it out");
    if (names.size() < 2)
        reader.fail(place,
                    fmt::format("model '{}' has fewer than two parameters, which a bench drives", bench.model.name),
                    "take another model");
    bench.parameter = vary.axes.empty() ? names.front() : vary.axes.front().name;
    std::vector<double> values =
        vary.axes.empty() ? std::vector<double>{bench.model.parameter_values().front()} : vary.axes.front().values;
    if (!vary.axes.empty() && vary.direction == SweepDirection::both)
        run.record().directions = {"up", "down"};
    else if (!vary.axes.empty())
        run.record().directions = {vary.direction == SweepDirection::up ? "up" : "down"};
    const auto add = [&](bool rising, std::size_t direction) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            bench.levels.push_back(values[rising ? i : values.size() - 1 - i]);
            bench.directions.push_back(direction);
        }
    };
    add(vary.direction != SweepDirection::down, 0);
    if (vary.direction == SweepDirection::both)
        add(false, 1);
    bench.carry = vary.carry && !vary.axes.empty();
    bench.seed = vary.seed;
    if (bench.carry && bench.repeats > 1)
        reader.fail(place, "levels that are gone through one after the other are recorded once",
                    "give carry = false, for each record to begin at the initial state");
    if (static_cast<double>(bench.levels.size()) * static_cast<double>(bench.repeats) > most_bench_records)
        reader.fail(place, fmt::format("there would be more than {} records", most_bench_records),
                    "take larger steps, or fewer repeats");
    vary.axes.clear();
}

} // namespace graze
