#include "study/run_forms.hpp"

#include "graze/base/file_name.hpp"
#include "graze/symbolic/parser.hpp"
#include "study/point_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace graze {

namespace {

/// @throws InputError for a section that the model does not have
std::size_t section_index(const StudyReader& reader, const Model& model, const TomlEntry& entry) {
    const std::string name = reader.toml().string(entry);
    if (const auto index = model.find_section(name))
        return *index;
    reader.fail(entry, fmt::format("model '{}' has no section '{}'", model.name, name),
                study_name_remedy(name, names_of(model.sections)));
}

/// Those that are named, or all barriers. @throws InputError for one that the model does not have
std::vector<std::size_t> events_of(const StudyReader& reader, const Model& model, const TomlEntry& entry) {
    std::vector<std::size_t> events;
    if (entry.node->is_boolean()) {
        for (std::size_t i = 0; i < model.events.size(); ++i)
            if (model.events[i].kind == EventKind::barrier)
                events.push_back(i);
        return events;
    }
    for (const std::string& name : reader.strings(entry)) {
        const auto index = model.find_event(name);
        if (!index)
            reader.fail(entry, fmt::format("model '{}' has no event '{}'", model.name, name),
                        study_name_remedy(name, names_of(model.events)));
        events.push_back(*index);
    }
    return events;
}

Sampling read_sampling(const StudyReader& reader, const Model& model, const TomlEntry& entry) {
    Sampling sampling;
    sampling.name = entry.name;
    require_plain_line(sampling.name, "name of a sampling", entry.place);
    bool placed = false;
    reader.each_of(entry, {"section", "maxima", "minima", "extrema", "contacts", "image"}, [&](const TomlEntry& item) {
        if (item.name == "image") {
            const std::string name = reader.toml().string(item);
            const std::vector<std::string> known = names_of(model.symmetries);
            const auto found = std::find(known.begin(), known.end(), name);
            if (found == known.end())
                reader.fail(item, fmt::format("model '{}' declares no symmetry '{}'", model.name, name),
                            study_name_remedy(name, known));
            sampling.symmetry = static_cast<std::size_t>(found - known.begin());
            return;
        }
        if (placed)
            reader.fail(entry, fmt::format("{} is taken in two places", entry.path), "make two samplings of it");
        placed = true;
        if (item.name == "section") {
            sampling.section = model.sections[section_index(reader, model, item)].name;
        } else if (item.name == "contacts") {
            sampling.at = Sampling::At::contact;
            sampling.events = events_of(reader, model, item);
        } else {
            sampling.at = Sampling::At::extremum;
            sampling.expression = named_value(model, reader.toml().string(item), reader.inside(item)).value;
            sampling.direction = item.name == "maxima"   ? Direction::falling
                                 : item.name == "minima" ? Direction::rising
                                                         : Direction::both;
        }
    });
    if (!placed)
        reader.fail(entry, fmt::format("{} does not say where", entry.path),
                    "give one of section, maxima, minima, extrema or contacts");
    return sampling;
}

} // namespace

void read_samplings(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    if (entry.node->is_table()) {
        reader.each_of(entry, {}, [&](const TomlEntry& item) {
            run.motion().samplings.push_back(read_sampling(reader, run.model, item));
        });
        return;
    }
    const auto items = entry.node->is_string() ? std::vector<TomlEntry>{entry} : reader.toml().elements(entry);
    reader.each(items, [&](const TomlEntry& item) {
        Sampling sampling;
        sampling.section = sampling.name = run.model.sections[section_index(reader, run.model, item)].name;
        run.motion().samplings.push_back(sampling);
    });
}

void read_values(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    std::set<std::string> taken;
    const auto items = entry.node->is_string() ? std::vector<TomlEntry>{entry} : reader.toml().elements(entry);
    reader.each(items, [&](const TomlEntry& item) {
        std::string text = reader.toml().line(item), name;
        Place place = reader.inside(item);
        if (const std::size_t equals = text.find('='); equals != std::string::npos) {
            name = text.substr(0, equals);
            name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
            place.column += static_cast<int>(equals) + 1;
            text = text.substr(equals + 1);
            if (!is_valid_name(name))
                reader.fail(item, fmt::format("'{}' cannot be a name", name),
                            "use letters, digits and '_', and no word that expressions use");
        }
        const NamedValue value = named_value(run.model, text, place);
        name = name.empty() ? value.name : name;
        if (!taken.insert(name).second)
            reader.fail(item, fmt::format("there are two values '{}'", name), "leave one of them out");
        run.value_names.push_back(name);
        run.value_units.push_back(value.unit);
        run.values.push_back(value.value);
    });
}

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

void read_within(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        const auto state = run.model.find_state(item.name);
        if (!state)
            throw InputError(item.place, fmt::format("the model has no state '{}'", item.name),
                             study_name_remedy(item.name, names_of(run.model.states)));
        const auto [least, greatest] = reader.range(run.model, item);
        run.branch().within.push_back({*state, least, greatest});
    });
    if (run.branch().within.empty())
        reader.fail(entry, fmt::format("{} names no state", entry.path),
                    "write within = { STATE = [LEAST, GREATEST] }, or leave it out");
}

namespace {

/// Which branch through a point, or which curve.
std::vector<std::string> words_of_onto() {
    std::vector<std::string> names = short_names_of_points(&PointKind::may_be_kept);
    names.insert(names.begin(), {"same", "other", "twin", "homoclinic"});
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
