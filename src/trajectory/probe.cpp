#include "graze/trajectory/probe.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/name_list.hpp"

#include <fmt/format.h>

namespace graze {

Probe section_probe(const Model& model, std::string_view name) {
    const auto index = model.find_section(name);
    if (!index) {
        std::vector<std::string> names;
        for (const Section& section : model.sections)
            names.push_back(section.name);
        const std::string nearest = nearest_name(name, names);
        throw InputError(fmt::format("model '{}' has no section '{}'", model.name, name),
                         names.empty()     ? "declare one under [sections] in the model file"
                         : nearest.empty() ? fmt::format("its sections are: {}", fmt::join(names, ", "))
                                           : fmt::format("did you mean '{}'?", nearest));
    }
    const Section& section = model.sections[*index];
    Probe probe;
    probe.name = section.name;
    if (section.state) {
        probe.kind = Probe::Kind::phase;
        probe.state = *section.state;
        probe.value = section.value;
    } else {
        probe.expression = section.function;
        probe.direction = section.direction;
    }
    return probe;
}

} // namespace graze
