#include "study/study_sampling.hpp"

#include "graze/base/file_name.hpp"
#include "graze/symbolic/parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace graze {

std::size_t section_index(const StudyReader& reader, const Model& model, const TomlEntry& entry) {
    const std::string name = reader.toml().string(entry);
    if (const auto index = model.find_section(name))
        return *index;
    reader.fail(entry, fmt::format("model '{}' has no section '{}'", model.name, name),
                study_name_remedy(name, names_of(model.sections)));
}

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

namespace {

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

} // namespace graze
