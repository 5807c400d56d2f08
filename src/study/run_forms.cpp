#include "study/run_forms.hpp"

#include "study/point_limits.hpp"
#include "study/start_state.hpp"
#include "study/study_sampling.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

void read_vary(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    std::vector<Variation>& axes = run.kind == RunKind::record ? run.record().vary.axes : run.motion().axes;
    double points = 1;
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        axes.push_back(read_variation(reader, run.model, item));
        points *= static_cast<double>(std::max<std::size_t>(axes.back().values.size(), 1));
        if (points > most_points) // before the next axis takes room
            reader.fail(entry, "there would be more than a thousand million points", "take larger steps");
    });
}

void read_section(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    run.attractor().section = run.model.sections[section_index(reader, run.model, entry)].name;
}

void read_bounds(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        const auto state = run.model.find_state(item.name);
        if (!state)
            throw InputError(item.place, fmt::format("the model has no state '{}'", item.name),
                             "give bounds of states: { q = [-1, 1] }");
        const auto [least, greatest] = reader.range(run.model, item);
        run.attractor().bounds.push_back({*state, least, greatest});
    });
    if (run.has_motions())
        run.motion().transient.bounds = run.motion().attractor.bounds;
}

namespace {

/// Which branch through a point, or which curve.
std::vector<std::string> words_of_onto() {
    std::vector<std::string> names{"same", "other", "twin"};
    for (const PointKind& kind : point_kinds())
        if (kind.may_be_kept)
            names.emplace_back(kind.short_name);
    return names;
}

} // namespace

void read_start(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    StartFrom start;
    start.place = entry.place;
    reader.each_of(entry, {"run", "at", "direction", "point", "onto"}, [&](const TomlEntry& item) {
        if (item.name == "run") {
            start.run = reader.toml().string(item);
        } else if (item.name == "direction") {
            reader.choice(item, {"up", "down"});
            start.direction = reader.toml().string(item);
        } else if (item.name == "point") {
            start.point = item.node->is_integer() ? std::to_string(reader.count(item)) : reader.toml().string(item);
        } else if (item.name == "onto") {
            reader.choice(item, words_of_onto());
            start.onto = reader.toml().string(item);
        } else {
            const auto at = reader.toml().entries(reader.toml().table(item), item.path);
            if (at.size() != 1)
                reader.fail(item, fmt::format("{} names {} coordinates", item.path, at.size()), "name one");
            start.coordinate = at.front().name;
            start.value = reader.number(run.model, at.front());
        }
    });
    if (start.run.empty())
        reader.fail(entry, fmt::format("{} names no run", entry.path), "write { run = \"NAME\", at = { V = 1 } }");
    run.start = start;
}

void read_parameters(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    run.parameters = reader.strings(entry);
    run.parameters_place = entry.place;
    if (run.parameters.empty())
        reader.fail(entry, fmt::format("{} names no run", entry.path), "name a run of kind \"identify\"");
}

void read_skip(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    reader.each_of(entry, {"time", "periods"}, [&](const TomlEntry& item) {
        if (item.name == "time")
            run.motion().transient.skip_time = reader.positive(run.model, item);
        else
            run.motion().transient.skip_periods = reader.count(item);
    });
}

void read_counted(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    run.motion().transient.counted = events_of(reader, run.model, entry);
}

} // namespace graze
